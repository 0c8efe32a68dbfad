// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "scene/description/box_tree.h"

namespace greatx::scene {

/// A tree of the boxes of triangles. It finds the triangles that a segment may touch.
class TriangleTree {
 public:
  explicit TriangleTree(std::span<const FacetTriangle> triangles);
  /// Appends, ascending, the indices of the triangles whose box comes within `distance_m` of the segment.
  void near_segment(const dvec3& a, const dvec3& b, double distance_m, std::vector<uint32_t>& found) const;

 private:
  BoxTree boxes_;
};

}  // namespace greatx::scene
