// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "rf/reference/occluders.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "core/error.h"

namespace greatx::rf::reference {

namespace {

double largest(const dvec3& v) { return std::max({std::abs(v.x), std::abs(v.y), std::abs(v.z)}); }

/// Returns the place where a-b meets a closed triangle between its ends, as a fraction. There, the three
/// volumes that the segment's line spans with the edges have one sign (C. Ericson, "Real-Time Collision
/// Detection", 2005, section 5.3.4).
std::optional<double> meets(const dvec3& a, const dvec3& b, const dvec3 (&corners)[3]) {
  const dvec3 normal = glm::cross(corners[1] - corners[0], corners[2] - corners[0]);
  const double at_a = glm::dot(normal, a - corners[0]), at_b = glm::dot(normal, b - corners[0]);
  if (at_a == at_b || at_a * at_b > 0.0) return std::nullopt;
  const dvec3 along = b - a;
  double volume[3];
  for (int i = 0; i < 3; ++i)
    volume[i] = glm::dot(along, glm::cross(corners[i] - a, corners[(i + 1) % 3] - a));
  const bool positive = volume[0] >= 0.0 && volume[1] >= 0.0 && volume[2] >= 0.0;
  const bool negative = volume[0] <= 0.0 && volume[1] <= 0.0 && volume[2] <= 0.0;
  if (!positive && !negative) return std::nullopt;
  return at_a / (at_a - at_b);
}

}  // namespace

Occluders::Occluders(const scene::Scene& scene, const FacetWorld& world, std::span<const Pose> body_poses,
                     const FacetKinds& kinds)
    : world_(&world), kinds_(&kinds), tree_({}) {
  GREATX_CHECK(kinds.size() == scene.facets.size() && world.facet_count() == scene.facets.size(),
               "{} kinds, {} posed facets of {}", kinds.size(), world.facet_count(), scene.facets.size());
  std::vector<scene::Bounds> boxes;
  for (uint32_t f = 0; f < scene.facets.size(); ++f) {
    const scene::Facet& facet = scene.facets[f];
    GREATX_CHECK(facet.body == 0 || facet.body < body_poses.size(), "facet {}: body {} of {}", f, facet.body,
                 body_poses.size());
    const Pose pose = facet.body == 0 ? Pose{} : body_poses[facet.body];
    for (uint32_t t = 0; t < facet.triangle_count; ++t) {
      Triangle triangle{{}, f};
      scene::Bounds box;
      for (int c = 0; c < 3; ++c) {
        const dvec3 corner = scene.facet_triangles[facet.first_triangle + t].corners[c];
        triangle.corners[c] = facet.body == 0 ? corner : pose.apply(corner);
        box.add(triangle.corners[c]);
      }
      if (t == 0) first_corners_.push_back(triangle.corners[0]);
      if (kinds[f] != FacetKind::opaque && kinds[f] != FacetKind::wall) continue;
      triangles_.push_back(triangle);
      boxes.push_back(box);
    }
  }
  tree_ = BoxTree(boxes);
}

bool Occluders::passed_over(const Stretch& stretch, uint32_t index) const {
  if (index == stretch.facet_a || index == stretch.facet_b) return true;
  if (index == stretch.other_a || index == stretch.other_b) return true;
  const PosedFacet& facet = world_->facet(index);
  if (facet.owner == stretch.body_a || facet.owner == stretch.body_b) return true;
  const double corner = largest(first_corners_[index]);
  const auto in_plane = [&](const dvec3& end) {
    return std::abs(facet.distance(end)) <= 1e-4 + 0x1p-22 * std::max(largest(end), corner);
  };
  return in_plane(stretch.a) || in_plane(stretch.b);
}

/// Applies the rule of rf/paths/crossings.h: walls in one plane are one wall, and so are walls that are met
/// in their common edge, within the tolerance of visibility.
bool Occluders::one_wall(const Stretch& stretch, const WallPassed& a, const WallPassed& b) const {
  const double tolerance = 1e-4 + 0x1p-22 * std::max(largest(stretch.a), largest(stretch.b));
  const dvec3 turned = glm::cross(world_->facet(a.facet).normal, world_->facet(b.facet).normal);
  if (glm::length(turned) < 1e-3)
    return std::abs(world_->facet(a.facet).distance(first_corners_[b.facet])) <= tolerance;
  return std::abs(a.t - b.t) * glm::distance(stretch.a, stretch.b) <= tolerance;
}

bool Occluders::free_but_for(const Stretch& stretch, uint32_t budget, std::vector<WallPassed>& passed) const {
  std::vector<WallPassed> met;
  bool blocked = false;
  tree_.along(stretch.a, stretch.b, [&](uint32_t index) {
    if (blocked) return;
    const Triangle& triangle = triangles_[index];
    const std::optional<double> t = meets(stretch.a, stretch.b, triangle.corners);
    if (!t || passed_over(stretch, triangle.facet)) return;
    blocked = (*kinds_)[triangle.facet] == FacetKind::opaque;
    met.push_back({*t, triangle.facet});
  });
  if (blocked) return false;
  // The order is by facet first, so that the lowest index of walls in one place is kept, whatever the
  // roundings of t.
  std::sort(met.begin(), met.end(), [](const WallPassed& a, const WallPassed& b) {
    return a.facet != b.facet ? a.facet < b.facet : a.t < b.t;
  });
  std::vector<WallPassed> walls;
  for (const WallPassed& wall : met) {
    const auto known = [&](const WallPassed& w) {
      return w.facet == wall.facet || one_wall(stretch, w, wall);
    };
    if (std::none_of(walls.begin(), walls.end(), known)) walls.push_back(wall);
  }
  std::sort(walls.begin(), walls.end(), [](const WallPassed& a, const WallPassed& b) {
    return a.t != b.t ? a.t < b.t : a.facet < b.facet;
  });
  passed.insert(passed.end(), walls.begin(), walls.end());
  return walls.size() <= budget;
}

}  // namespace greatx::rf::reference
