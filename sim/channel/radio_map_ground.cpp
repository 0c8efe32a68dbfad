// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "sim/channel/radio_map_ground.h"

#include <algorithm>
#include <cmath>
#include <functional>

namespace greatx::sim {

namespace {

using scene::SemanticClass;

bool is_ground(SemanticClass c) {
  return c == SemanticClass::ground || c == SemanticClass::road || c == SemanticClass::pavement ||
         c == SemanticClass::lane_marking || c == SemanticClass::water;
}

bool is_ground_or_building(SemanticClass c) {
  return is_ground(c) || c == SemanticClass::unlabeled || c == SemanticClass::building ||
         c == SemanticClass::roof || c == SemanticClass::window;
}

constexpr double least_slope = 1e-6;  ///< least |n_z| of a surface; steeper ones are walls

/// Returns the triangles of the static world whose class counts. With `up_alone`, their normals must point
/// up; otherwise either side may.
std::vector<scene::FacetTriangle> surfaces(const scene::Scene& scene,
                                           const std::function<bool(SemanticClass)>& counts, bool up_alone) {
  std::vector<scene::FacetTriangle> triangles;
  for (const scene::Facet& facet : scene.facets) {
    if (facet.body != 0 || !counts(scene.instances[facet.instance].semantic_class)) continue;
    if ((up_alone ? facet.normal.z : std::abs(facet.normal.z)) < least_slope) continue;
    for (uint32_t t = 0; t < facet.triangle_count; ++t)
      triangles.push_back(scene.facet_triangles[facet.first_triangle + t]);
  }
  return triangles;
}

/// Returns the height of the triangle's plane at p if p lies in the triangle or within rounding of its edges.
std::optional<double> height_at(const scene::FacetTriangle& triangle, const dvec2& p) {
  const dvec3 *a = &triangle.corners[0], *b = &triangle.corners[1], *c = &triangle.corners[2];
  const auto cross = [](const dvec2& u, const dvec2& v) { return u.x * v.y - u.y * v.x; };
  const dvec2 ab(*b - *a), ac(*c - *a), ap(p - dvec2(*a));
  const double area = cross(ab, ac);
  if (area == 0.0) return std::nullopt;
  const double v = cross(ap, ac) / area, w = cross(ab, ap) / area;
  constexpr double rounding = 1e-9;
  if (v < -rounding || w < -rounding || v + w > 1.0 + rounding) return std::nullopt;
  return a->z + v * (b->z - a->z) + w * (c->z - a->z);
}

}  // namespace

GroundHeights::GroundHeights(const scene::Scene& scene, MapOver over) : origin_(scene.origin), tree_({}) {
  if (over == MapOver::roofs) {
    triangles_ = surfaces(scene, is_ground_or_building, false);
    rule_ = "the highest surface of ground and buildings";
  } else {
    triangles_ = surfaces(scene, is_ground, false);
    rule_ = "the highest surface of class ground, road, pavement, lane_marking or water";
    if (triangles_.empty()) {
      triangles_ = surfaces(
          scene, [](SemanticClass) { return true; }, true);
      rule_ =
          "the lowest surface that faces up (the scene has none of class ground, road, pavement, "
          "lane_marking or water)";
      lowest_ = true;
    }
  }
  tree_ = scene::TriangleTree(triangles_);
  below_ = scene.bounds.min.z - 1.0;
  above_ = scene.bounds.max.z + 1.0;
}

std::optional<double> GroundHeights::at(const dvec2& world) const {
  const dvec2 p = world - dvec2(origin_);
  std::vector<uint32_t> near;
  tree_.near_segment({p, below_}, {p, above_}, 1e-6, near);
  std::optional<double> found;
  for (const uint32_t index : near)
    if (const auto z = height_at(triangles_[index], p))
      found = !found ? *z : lowest_ ? std::min(*found, *z) : std::max(*found, *z);
  if (found) *found += origin_.z;
  return found;
}

}  // namespace greatx::sim
