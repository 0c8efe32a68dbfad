// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "rf/paths/exact_crossings.h"

#include <algorithm>
#include <cmath>

namespace greatx::rf {

namespace {

double largest_of(const dvec3& v) { return std::max({std::abs(v.x), std::abs(v.y), std::abs(v.z)}); }

/// Returns CrossingPass's tolerance for an end on a facet's plane.
double tolerance_of(double coordinate) {
  return static_cast<double>(shared::visibility_tolerance(static_cast<float>(coordinate)));
}

/// Returns whether the end lies on the facet's plane and the facet does not count because of that. It counts
/// if the end is a point of another facet that stands at an angle to this one (`own`; `other`: the end is on
/// an edge), unless it lies on the plane as far as fp64 can tell.
bool excused(const FacetWorld& world, const PosedFacet& facet, double corner, const dvec3& end, uint32_t own,
             uint32_t other) {
  const double distance = std::abs(facet.distance(end));
  if (distance > tolerance_of(std::max(largest_of(end), corner))) return false;
  if (own == shared::rf_none || other != shared::rf_none || distance <= facet.tolerance_m) return true;
  const dvec3 sine = glm::cross(world.facet(own).normal, facet.normal);
  return glm::length(sine) < static_cast<double>(shared::crossings_seam_sine);
}

/// Returns whether the segment misses the box.
bool misses(const scene::Bounds& box, const dvec3& a, const dvec3& b) {
  double enter = 0.0, leave = 1.0;
  for (int axis = 0; axis < 3; ++axis) {
    const double along = b[axis] - a[axis];
    // Facets are closed within their tolerance, 1e-9 of the extent and more.
    const double room = 1e-6 + 1e-8 * std::max(std::abs(box.min[axis]), std::abs(box.max[axis]));
    const double low = box.min[axis] - room - a[axis], high = box.max[axis] + room - a[axis];
    if (along == 0.0) {
      if (low > 0.0 || high < 0.0) return true;
      continue;
    }
    enter = std::max(enter, std::min(low / along, high / along));
    leave = std::min(leave, std::max(low / along, high / along));
  }
  return enter > leave;
}

}  // namespace

ExactCrossings::ExactCrossings(const scene::Scene& scene, const FacetKinds& kinds) : kinds_(kinds) {
  std::vector<scene::Bounds> boxes;
  for (uint32_t index = 0; index < scene.facets.size(); ++index) {
    const scene::Facet& facet = scene.facets[index];
    if (kinds[index] != FacetKind::opaque && kinds[index] != FacetKind::wall) continue;
    if (facet.body != 0) {
      moving_.push_back(index);
      continue;
    }
    fixed_.push_back(index);
    boxes.emplace_back();
    for (uint32_t t = 0; t < facet.triangle_count; ++t)
      for (const dvec3& corner : scene.facet_triangles[facet.first_triangle + t].corners)
        boxes.back().add(corner);
  }
  boxes_ = scene::BoxTree(boxes);
}

std::optional<ExactCrossings::Met> ExactCrossings::meets(const FacetWorld& world, const Segment& segment,
                                                         uint32_t index) {
  for (const uint32_t named : {segment.facet_a, segment.facet_b, segment.other_a, segment.other_b})
    if (index == named) return std::nullopt;
  const PosedFacet& facet = world.facet(index);
  if (facet.owner == segment.body_a || facet.owner == segment.body_b) return std::nullopt;
  const double from = facet.distance(segment.a), to = facet.distance(segment.b);
  if (from == to || from * to > 0.0) return std::nullopt;
  const double t = from / (from - to);
  if (!world.contains(index, facet.plane_coordinates(segment.a + t * (segment.b - segment.a))))
    return std::nullopt;
  const double corner = largest_of(world.corners(index, 0)[0]);
  if (excused(world, facet, corner, segment.a, segment.facet_a, segment.other_a) ||
      excused(world, facet, corner, segment.b, segment.facet_b, segment.other_b))
    return std::nullopt;
  return Met{t, index};
}

/// Walls in one plane are one wall, and so are walls that are met in their common edge. The lowest index is
/// kept, whatever the roundings of t.
std::vector<uint32_t> ExactCrossings::walls_of(const FacetWorld& world, const Segment& segment,
                                               std::vector<Met>& met) {
  std::ranges::sort(met, {}, &Met::facet);
  const double tolerance = tolerance_of(std::max(largest_of(segment.a), largest_of(segment.b)));
  const double length = glm::distance(segment.a, segment.b);
  std::vector<Met> kept;
  for (const Met& wall : met) {
    const auto same = [&](const Met& known) {
      const PosedFacet &p = world.facet(known.facet), &q = world.facet(wall.facet);
      if (glm::length(glm::cross(p.normal, q.normal)) < 1e-3)
        return std::abs(p.distance(world.corners(wall.facet, 0)[0])) <= tolerance;
      return std::abs(known.t - wall.t) * length <= tolerance;
    };
    if (std::ranges::none_of(kept, same)) kept.push_back(wall);
  }
  std::vector<uint32_t> walls;
  for (const Met& wall : kept) walls.push_back(wall.facet);
  return walls;
}

void ExactCrossings::settle(const FacetWorld& world, const Segment& segment, Crossing& crossing) const {
  std::vector<Met> walls;
  const auto blocks = [&](uint32_t facet) {
    const std::optional<Met> met = meets(world, segment, facet);
    if (!met) return false;
    if (kinds_[facet] == FacetKind::opaque) return true;
    walls.push_back(*met);
    return false;
  };
  crossing.undecided = false;
  crossing.walls.clear();
  crossing.blocked =
      boxes_.visit_until([&](const scene::Bounds& box) { return misses(box, segment.a, segment.b); },
                         [&](uint32_t i) { return blocks(fixed_[i]); });
  for (size_t i = 0; i < moving_.size() && !crossing.blocked; ++i) crossing.blocked = blocks(moving_[i]);
  if (crossing.blocked) return;
  crossing.walls = walls_of(world, segment, walls);
  crossing.blocked = crossing.walls.size() > segment.walls;
}

}  // namespace greatx::rf
