// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "sim/world/solids.h"

#include "core/error.h"

namespace greatx::sim {
namespace {

rf::FacetKinds kinds_of(const scene::Scene& scene) {
  rf::FacetKinds kinds;
  for (const scene::Facet& facet : scene.facets) {
    const std::optional<scene::RadioMaterial>& radio = scene.materials[facet.material].radio;
    kinds.push_back(radio && radio->foliage ? rf::FacetKind::foliage : rf::FacetKind::opaque);
  }
  return kinds;
}

}  // namespace

Solids::Solids(const scene::Scene& scene)
    : scene_(scene), kinds_(kinds_of(scene)), surroundings_(scene, kinds_) {
  std::vector<Shell> shells(scene.bodies.size());
  for (uint32_t index = 0; index < scene.facets.size(); ++index) {
    const scene::Facet& facet = scene.facets[index];
    Shell& shell = shells[facet.body];
    for (uint32_t t = 0; t < facet.triangle_count; ++t) {
      shell.triangles.push_back(scene.facet_triangles[facet.first_triangle + t]);
      shell.facets.push_back(index);
    }
  }
  for (uint32_t body = 0; body < shells.size(); ++body) {
    if (body > 0 && shells[body].triangles.empty()) continue;
    shells[body].body = body;
    shells[body].tree = std::make_unique<scene::TriangleTree>(shells[body].triangles);
    shells_.push_back(std::move(shells[body]));
  }
}

const std::string& Solids::object_of(uint32_t facet) const {
  return scene_.instances[scene_.facets[facet].instance].name;
}

double Solids::distance(const dvec3& point, double most_m) const {
  return shells_[0].tree->distance(point, most_m, shells_[0].triangles);
}

std::optional<Solids::Met> Solids::first_met(const Shell& shell, const dvec3& from, const dvec3& along,
                                             double least_t, double most_t, bool through_foliage) const {
  std::vector<uint32_t> near;
  shell.tree->near_segment(from, from + most_t * along, 0.0, near);
  std::optional<Met> first;
  for (const uint32_t index : near) {
    const uint32_t facet = shell.facets[index];
    if (through_foliage && kinds_[facet] == rf::FacetKind::foliage) continue;
    const std::optional<double> t = scene::line_meets_triangle(from, along, shell.triangles[index]);
    if (t && *t > least_t && *t < most_t && (!first || *t < first->t)) first = Met{*t, facet};
  }
  return first;
}

std::optional<uint32_t> Solids::first_passed(const dvec3& from, const dvec3& to) const {
  constexpr double touches_m = 1e-3;  // a wheel that rests on a road does not pass through it
  const double length = glm::distance(from, to);
  if (length <= 2.0 * touches_m) return std::nullopt;
  const double end = touches_m / length;
  const std::optional<Met> met = first_met(shells_[0], from, to - from, end, 1.0 - end, true);
  return met ? std::optional(met->facet) : std::nullopt;
}

std::optional<uint32_t> Solids::first_seen(const dvec3& origin, const dvec3& direction,
                                           std::span<const Pose> body_poses, uint32_t own_body) const {
  constexpr double begins_m = 1e-6;
  std::optional<Met> first;
  double reach = 1e7;
  for (const Shell& shell : shells_) {
    if (shell.body != 0 && scene_.owner_of(shell.body) == own_body) continue;
    GREATX_CHECK(shell.body == 0 || shell.body < body_poses.size(), "body {} of {} poses", shell.body,
                 body_poses.size());
    const Pose to_body = shell.body == 0 ? Pose{} : body_poses[shell.body].inverse();
    const std::optional<Met> met =
        first_met(shell, to_body.apply(origin), to_body.rotate(direction), begins_m, reach, false);
    if (!met) continue;
    first = met;
    reach = met->t;
  }
  return first ? std::optional(first->facet) : std::nullopt;
}

}  // namespace greatx::sim
