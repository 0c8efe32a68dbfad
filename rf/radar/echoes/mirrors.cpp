// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "rf/radar/echoes/mirrors.h"

#include <array>
#include <cmath>
#include <numeric>

#include "core/parallel.h"

namespace greatx::rf {
namespace {

/// Relative tolerance between two computations of the distance to a mirror.
constexpr double same_on_mirror = 1e-6;

/// Describes a target that is searched for over mirrors.
struct Sought {
  const TargetBox* box = nullptr;
  std::array<dvec3, 9> points;  ///< the centre of the box, and the points halfway to its corners
  double radius = 0.0;
};

Sought sought(const TargetBox& box) {
  Sought target{&box, {}, 0.5 * glm::length(box.bounds.size())};
  const dvec3 middle = box.bounds.center(), quarter = 0.25 * box.bounds.size();
  target.points[0] = box.pose.apply(middle);
  for (int corner = 0; corner < 8; ++corner)
    target.points[corner + 1] = box.pose.apply(
        middle + quarter * dvec3(corner & 1 ? 1 : -1, corner & 2 ? 1 : -1, corner & 4 ? 1 : -1));
  return target;
}

}  // namespace

MirrorFinder::MirrorFinder(const scene::Scene& scene, const FacetWorld& world, const RadioSurfaces& surfaces)
    : scene_(scene) {
  for (uint32_t facet = 0; facet < world.facet_count(); ++facet) {
    const PosedFacet& posed = world.facet(facet);
    if (surfaces.surface(posed.material).front.empty()) continue;
    mirrors_.push_back({facet, std::max(posed.max_u - posed.min_u, posed.max_v - posed.min_v)});
  }
  std::sort(mirrors_.begin(), mirrors_.end(), [](const Mirror& a, const Mirror& b) {
    return a.extent_m != b.extent_m ? a.extent_m > b.extent_m : a.facet < b.facet;
  });
  first_facet_.assign(scene.bodies.size() + 1, 0);
  for (const scene::Facet& facet : scene.facets) ++first_facet_[facet.body + 1];
  std::partial_sum(first_facet_.begin(), first_facet_.end(), first_facet_.begin());
}

void MirrorFinder::add_facets(const TargetBox& target, uint32_t mirror, const FacetWorld& world,
                              std::vector<MirroredFacet>& found) const {
  const auto add = [&](uint32_t body) {
    for (uint32_t facet = first_facet_[body]; facet < first_facet_[body + 1]; ++facet)
      if ((body != 0 || scene_.facets[facet].instance == target.instance) && mirrors(world, mirror, facet))
        found.push_back({mirror, facet});
  };
  if (target.body == 0) return add(0);
  const uint32_t owner = scene_.owner_of(target.body);
  for (uint32_t body = 1; body + 1 < first_facet_.size(); ++body)
    if (scene_.owner_of(body) == owner) add(body);
}

std::vector<MirroredFacet> MirrorFinder::find(std::span<const TargetBox> targets, const FacetWorld& world,
                                              const FacetTrees& trees, const EchoTracer& tracer,
                                              const dvec3& radar, uint32_t own_body, uint32_t threads) const {
  std::vector<MirroredFacet> images;
  if (targets.empty()) return images;
  const Search search{world, trees, tracer, radar, own_body, tracer.view(world, own_body)};
  std::vector<std::vector<MirroredFacet>> found(targets.size());
  parallel_for(targets.size(), threads, [&](size_t i) {
    if (!targets[i].bounds.empty()) find(targets[i], search, found[i]);
  });
  for (const auto& some : found) images.insert(images.end(), some.begin(), some.end());
  std::sort(images.begin(), images.end());
  images.erase(std::unique(images.begin(), images.end()), images.end());
  return images;
}

void MirrorFinder::find(const TargetBox& box, const Search& search, std::vector<MirroredFacet>& found) const {
  const FacetWorld& world = search.world;
  const dvec3& radar = search.radar;
  const Sought target = sought(box);
  const uint32_t owner = scene_.owner_of(box.body);
  const auto is_target = [&](uint32_t facet) {
    return box.body == 0 ? scene_.facets[facet].instance == box.instance : world.facet(facet).owner == owner;
  };
  for (const Mirror& mirror : mirrors_) {
    if (mirror.extent_m < target.radius) break;
    const PosedFacet& posed = world.facet(mirror.facet);
    const double side = posed.distance(radar), there = posed.distance(target.points[0]);
    if (!(side * there > 0.0)) continue;
    // The point where the ray to the image of the centre meets the plane. It may lie beside the facet by
    // `room`, since the rays to the corners of the box meet the plane up to that far from it.
    const double share = side / (side + there);
    const dvec2 from = posed.plane_coordinates(radar),
                at = from + share * (posed.plane_coordinates(target.points[0]) - from);
    const double room = share * target.radius;
    if (at.x < posed.min_u - room || at.x > posed.max_u + room || at.y < posed.min_v - room ||
        at.y > posed.max_v + room)
      continue;
    if (is_target(mirror.facet) || (search.own_body != 0 && posed.owner == search.own_body)) continue;
    const auto shows = [&](const dvec3& point) {
      const double height = posed.distance(point);
      if (!(side * height > 0.0)) return false;
      const dvec3 image = point - 2.0 * height * posed.normal;
      const dvec3 over = radar + side / (side + height) * (image - radar);
      if (!search.trees.contains(world, mirror.facet, over)) return false;
      const dvec3 out = over - radar, on = point - over;
      const EchoTracer::Met met = search.tracer.first(search.view, radar, glm::normalize(out), ~0u);
      if (met.facet != mirror.facet && met.distance < glm::length(out) * (1.0 - same_on_mirror)) return false;
      const EchoTracer::Met next = search.tracer.first(search.view, over, glm::normalize(on), mirror.facet);
      return next.distance >= glm::length(on) || is_target(next.facet);
    };
    if (std::any_of(target.points.begin(), target.points.end(), shows))
      add_facets(box, mirror.facet, world, found);
  }
}

}  // namespace greatx::rf
