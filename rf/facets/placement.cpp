// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "rf/facets/placement.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <optional>
#include <tuple>

#include "core/error.h"
#include "core/units.h"
#include "shaders/shared/rf.h"

namespace greatx::rf {

namespace {

constexpr size_t rays_around = 8, rays_above = 1 + rays_around, rays = rays_above + rays_around;

/// Returns the directions of the rays. The first ray goes upwards. Eight rays go 8 degrees above the horizon,
/// where objects without a floor are closed; wide roofs are met there as well. The last eight go along the
/// horizon, where a ray meets only walls. Apart from the horizontal, no direction lies in a plane that people
/// build.
std::array<dvec3, rays> directions() {
  std::array<dvec3, rays> all{glm::normalize(dvec3(0.0123, 0.0079, 1.0))};
  for (size_t i = 1; i < rays; ++i) {
    const double azimuth = 2.0 * pi * (static_cast<double>(i) + 0.1618) / rays_around,
                 elevation = i < rays_above ? radians(8.0) : 0.0;
    all[i] = {std::cos(elevation) * std::cos(azimuth), std::cos(elevation) * std::sin(azimuth),
              std::sin(elevation)};
  }
  return all;
}

double largest_coordinate(const dvec3& v) { return std::max({std::abs(v.x), std::abs(v.y), std::abs(v.z)}); }

double tolerance_of(const dvec3& point, const dvec3& corner) {
  return shared::visibility_tolerance(
      static_cast<float>(std::max(largest_coordinate(point), largest_coordinate(corner))));
}

}  // namespace

/// Describes a point where a ray crosses a surface: out of the solid (+1) or into it (-1).
struct Surroundings::Hit {
  double distance = 0.0;
  uint32_t facet = 0;
  int sign = 0;
  bool operator<(const Hit& other) const {
    return std::tie(distance, facet, sign) < std::tie(other.distance, other.facet, other.sign);
  }
};

Surroundings::Surroundings(const scene::Scene& scene, const FacetKinds& kinds) : scene_(&scene) {
  GREATX_CHECK(kinds.size() == scene.facets.size(), "kinds of {} facets, the scene has {}", kinds.size(),
               scene.facets.size());
  std::map<std::pair<uint32_t, bool>, Shell> shells;
  for (uint32_t index = 0; index < scene.facets.size(); ++index) {
    if (kinds[index] == FacetKind::absent) continue;
    const scene::Facet& facet = scene.facets[index];
    const bool foliage = kinds[index] == FacetKind::foliage;
    Shell& shell = shells
                       .try_emplace({facet.body, foliage},
                                    Shell{facet.body, foliage, {}, {}, {}, scene::TriangleTree({})})
                       .first->second;
    for (uint32_t t = 0; t < facet.triangle_count; ++t) {
      shell.triangles.push_back(facet.first_triangle + t);
      shell.facets.push_back(index);
    }
  }
  for (auto& [key, shell] : shells) {
    std::vector<scene::Bounds> boxes(shell.triangles.size());
    for (uint32_t t = 0; t < boxes.size(); ++t) {
      for (const dvec3& corner : triangle_of(shell, t).corners) boxes[t].add(corner);
      shell.bounds.add(boxes[t]);
    }
    shell.tree = scene::TriangleTree::of_boxes(boxes);
    shells_.push_back(std::move(shell));
  }
}

/// Returns the crossings of the ray with surfaces up to a distance, in the order along the ray.
std::vector<Surroundings::Hit> Surroundings::hits(const Shell& shell, const dvec3& point,
                                                  const dvec3& direction, double reach_m) const {
  std::vector<uint32_t> near;
  shell.tree.near_segment(point, point + reach_m * direction, 0.0, near);
  std::vector<Hit> list;
  for (const uint32_t index : near) {
    const scene::FacetTriangle& triangle = triangle_of(shell, index);
    const std::optional<double> distance = scene::line_meets_triangle(point, direction, triangle);
    if (!distance || *distance <= 0.0 || *distance >= reach_m) continue;
    const dvec3* corners = triangle.corners;
    const dvec3 normal = glm::cross(corners[1] - corners[0], corners[2] - corners[0]);
    const double height = glm::dot(normal, corners[0] - point);
    // A surface that the point lies on is on neither side of the point.
    if (std::abs(height) <= tolerance_of(point, corners[0]) * glm::length(normal)) continue;
    list.push_back({*distance, shell.facets[index], glm::dot(normal, direction) > 0.0 ? 1 : -1});
  }
  std::sort(list.begin(), list.end());
  return list;
}

/// Returns a facet of the surface that the ray leaves without having entered it, or `none`.
uint32_t Surroundings::comes_out_of(const Shell& shell, const dvec3& point, const dvec3& direction) const {
  const double all = glm::length(shell.bounds.size()) + glm::length(point - shell.bounds.center()) + 1.0;
  // Inside a house its wall is near, so that the first attempt is short.
  for (const double reach : {std::min(32.0, all), all}) {
    const std::vector<Hit> list = hits(shell, point, direction, reach);
    int out = 0;
    for (size_t i = 0; i < list.size();) {
      // The ray passes both sides of a sheet, or two walls back to back, at the same time.
      const double end = list[i].distance + 1e-6;
      if (end > reach) break;
      uint32_t left = Placement::none;
      for (; i < list.size() && list[i].distance <= end; ++i) {
        out += list[i].sign;
        if (list[i].sign > 0) left = list[i].facet;
      }
      if (out > 0) return left;
    }
  }
  return Placement::none;
}

/// Tells whether the first surface straight below is the top of something. Then the point is above a floor
/// and not in the ground.
bool Surroundings::floor_below(const Shell& shell, const dvec3& point) const {
  const double reach = std::max(0.0, point.z - shell.bounds.min.z) + 1.0;
  const std::vector<Hit> list = hits(shell, point, -directions()[0], 2.0 * reach);
  return !list.empty() && list.front().sign < 0;
}

/// A point is inside an object that all rays leave, and beneath a surface that only the rays above the
/// horizon leave. Otherwise one of these rays escapes.
void Surroundings::surround(const Shell& shell, const dvec3& point, Placement& placement) const {
  static const std::array<dvec3, rays> all = directions();
  std::array<uint32_t, rays> facets{};
  size_t out = 0;
  while (out < rays && (facets[out] = comes_out_of(shell, point, all[out])) != Placement::none) ++out;
  if (out == rays)
    (shell.foliage ? placement.foliage : placement.solid) = most_named(facets);
  else if (out >= rays_above && shell.body == 0 && !shell.foliage && !floor_below(shell, point))
    placement.beneath = most_named(std::span(facets).first(rays_above));
}

/// Returns a facet of the object that most of the rays leave.
uint32_t Surroundings::most_named(std::span<const uint32_t> facets) const {
  // Counts the rays that leave the object of `facet`, and those that leave it by the same material.
  const auto votes = [&](uint32_t facet) {
    const scene::Facet& own = scene_->facets[facet];
    std::pair<size_t, size_t> count;
    for (const uint32_t other : facets) {
      const scene::Facet& f = scene_->facets[other];
      count.first += f.instance == own.instance;
      count.second += f.instance == own.instance && f.material == own.material;
    }
    return count;
  };
  return *std::max_element(facets.begin(), facets.end(),
                           [&](uint32_t a, uint32_t b) { return votes(a) < votes(b); });
}

void Surroundings::touch(const Shell& shell, const dvec3& point, Placement& placement) const {
  const double reach = tolerance_of(point, glm::max(glm::abs(shell.bounds.min), glm::abs(shell.bounds.max)));
  std::vector<uint32_t> near;
  shell.tree.near_segment(point, point, reach, near);
  for (const uint32_t index : near) {
    const scene::FacetTriangle& triangle = triangle_of(shell, index);
    const double distance = glm::length(scene::nearest_on_triangle(point, triangle) - point);
    if (distance > tolerance_of(point, triangle.corners[0])) continue;
    if (placement.surface != Placement::none && placement.surface_m <= distance) continue;
    placement.surface = shell.facets[index];
    placement.surface_m = distance;
  }
}

Placement Surroundings::of(const dvec3& point, std::span<const Pose> body_poses, uint32_t own_body) const {
  Placement placement;
  for (const Shell& shell : shells_) {
    if (shell.body != 0 && scene_->owner_of(shell.body) == own_body) continue;
    GREATX_CHECK(shell.body < body_poses.size() || shell.body == 0, "body {} of {} poses", shell.body,
                 body_poses.size());
    place(shell, shell.body == 0 ? point : body_poses[shell.body].inverse().apply(point), placement);
  }
  return placement;
}

Placement Surroundings::in_static_world(const dvec3& point) const {
  Placement placement;
  for (const Shell& shell : shells_)
    if (shell.body == 0) place(shell, point, placement);
  return placement;
}

/// Adds what a shell says of a point in the frame of its body.
void Surroundings::place(const Shell& shell, const dvec3& point, Placement& placement) const {
  const double room = tolerance_of(point, shell.bounds.max);
  // A point below the static world is in the ground, if the world has one: it is tested for body 0.
  const bool below = point.z < shell.bounds.min.z - room && shell.body != 0;
  const bool beside = point.x < shell.bounds.min.x - room || point.y < shell.bounds.min.y - room;
  if (below || beside || glm::any(glm::greaterThan(point, shell.bounds.max + room))) return;
  if ((shell.foliage ? placement.foliage : placement.solid) == Placement::none)
    surround(shell, point, placement);
  if (!shell.foliage) touch(shell, point, placement);
}

double Surroundings::distance(const dvec3& point, double most_m) const {
  double nearest = most_m;
  for (const Shell& shell : shells_)
    if (shell.body == 0)
      nearest = shell.tree.distance(
          point, nearest, [&](uint32_t index) -> const auto& { return triangle_of(shell, index); });
  return nearest;
}

/// Describes where a line meets a facet: at `from` + t `along`.
struct Surroundings::Met {
  double t = 0.0;
  uint32_t facet = 0;
};

std::optional<Surroundings::Met> Surroundings::first_met(const Shell& shell, const dvec3& from,
                                                         const dvec3& along, double least_t,
                                                         double most_t) const {
  std::vector<uint32_t> near;
  shell.tree.near_segment(from, from + most_t * along, 0.0, near);
  std::optional<Met> first;
  for (const uint32_t index : near) {
    const std::optional<double> t = scene::line_meets_triangle(from, along, triangle_of(shell, index));
    if (t && *t > least_t && *t < most_t && (!first || *t < first->t)) first = Met{*t, shell.facets[index]};
  }
  return first;
}

std::optional<uint32_t> Surroundings::first_passed(const dvec3& from, const dvec3& to) const {
  constexpr double touches_m = 1e-3;  // a wheel that rests on a road does not pass through it
  const double length = glm::distance(from, to);
  if (length <= 2.0 * touches_m) return std::nullopt;
  const double end = touches_m / length;
  for (const Shell& shell : shells_) {
    if (shell.body != 0 || shell.foliage) continue;
    if (const std::optional<Met> met = first_met(shell, from, to - from, end, 1.0 - end)) return met->facet;
  }
  return std::nullopt;
}

std::optional<uint32_t> Surroundings::first_seen(const dvec3& origin, const dvec3& direction,
                                                 std::span<const Pose> body_poses, uint32_t own_body) const {
  constexpr double begins_m = 1e-6;
  std::optional<Met> first;
  double reach = 1e7;
  for (const Shell& shell : shells_) {
    if (shell.body != 0 && scene_->owner_of(shell.body) == own_body) continue;
    GREATX_CHECK(shell.body == 0 || shell.body < body_poses.size(), "body {} of {} poses", shell.body,
                 body_poses.size());
    const Pose to_body = shell.body == 0 ? Pose{} : body_poses[shell.body].inverse();
    const std::optional<Met> met =
        first_met(shell, to_body.apply(origin), to_body.rotate(direction), begins_m, reach);
    if (!met) continue;
    first = met;
    reach = met->t;
  }
  return first ? std::optional(first->facet) : std::nullopt;
}

std::string describe(const Placement& placement, const scene::Scene& scene, const FacetKinds& kinds) {
  const auto name_of = [&](uint32_t facet) {
    const scene::Facet& f = scene.facets[facet];
    return fmt::format("'{}' (material {})", scene.instances[f.instance].name,
                       scene.materials[f.material].name);
  };
  std::string text;
  const auto add = [&](const std::string& more) { text += (text.empty() ? "" : "; ") + more; };
  if (placement.solid != Placement::none)
    add(fmt::format("lies inside {}: {}", name_of(placement.solid),
                    kinds[placement.solid] == FacetKind::wall ? "what is outside it sees through walls alone"
                                                              : "it sees only what is inside"));
  if (placement.beneath != Placement::none && placement.solid == Placement::none)
    add(fmt::format("lies beneath {}, an open surface with nothing below: {}", name_of(placement.beneath),
                    kinds[placement.beneath] == FacetKind::wall ? "what is above it sees through that alone"
                                                                : "it sees nothing that is above"));
  if (placement.surface != Placement::none)
    add(fmt::format(
        "lies on a surface of {}, {:.2g} mm off it: that one neither blocks nor hides anything from it",
        name_of(placement.surface), 1e3 * placement.surface_m));
  if (placement.foliage != Placement::none)
    add(fmt::format("lies inside the foliage of {}: every path of it is attenuated",
                    name_of(placement.foliage)));
  return text.empty() ? "is free" : text;
}

}  // namespace greatx::rf
