// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "scene/description/box_tree.h"

namespace greatx::scene {

/// Returns the point of a triangle that is nearest to `p` (C. Ericson, "Real-Time Collision Detection",
/// 5.1.5). The triangle may be a line or a point.
dvec3 nearest_on_triangle(const dvec3& p, const FacetTriangle& triangle);

/// Returns t of the point origin + t * direction where a line passes through the triangle, or nothing if it
/// passes beside it or within its plane. The two triangles of an edge never both miss a line that passes
/// between them.
std::optional<double> line_meets_triangle(const dvec3& origin, const dvec3& direction,
                                          const FacetTriangle& triangle);

/// A tree of the boxes of triangles. It finds the triangles that a segment may touch.
class TriangleTree {
 public:
  explicit TriangleTree(std::span<const FacetTriangle> triangles);
  /// Makes the tree of triangles that are elsewhere, from their boxes.
  static TriangleTree of_boxes(std::span<const Bounds> boxes) {
    TriangleTree tree({});
    tree.boxes_ = BoxTree(boxes);
    return tree;
  }
  /// Appends, ascending, the indices of the triangles whose box comes within `distance_m` of the segment.
  void near_segment(const dvec3& a, const dvec3& b, double distance_m, std::vector<uint32_t>& found) const;

  /// Returns the distance from `point` to the nearest triangle, or `most_m` if none is nearer than that.
  /// `triangle_at` returns a triangle by its index.
  template <typename TriangleAt>
  double distance(const dvec3& point, double most_m, const TriangleAt& triangle_at) const {
    double nearest = most_m;
    boxes_.visit_until(
        [&](const Bounds& box) {
          return glm::length(glm::max(glm::max(box.min - point, point - box.max), dvec3(0.0))) >= nearest;
        },
        [&](uint32_t index) {
          nearest = std::min(nearest, glm::distance(nearest_on_triangle(point, triangle_at(index)), point));
          return false;
        });
    return nearest;
  }

 private:
  BoxTree boxes_;
};

}  // namespace greatx::scene
