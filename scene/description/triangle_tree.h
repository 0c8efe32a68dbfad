// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "scene/description/scene.h"

namespace greatx::scene {

/// Boxes around triangles, halved along their longest axis: which triangles may a segment touch?
class TriangleTree {
 public:
  explicit TriangleTree(std::span<const FacetTriangle> triangles);
  /// Appends, ascending, the indices of triangles whose box comes within `distance_m` of the segment.
  void near_segment(const dvec3& a, const dvec3& b, double distance_m, std::vector<uint32_t>& found) const;

 private:
  struct TreeNode {
    Bounds bounds;
    uint32_t first = 0,
             count = 0;  ///< of order_; count 0: an inner node, its children at `first` and `first` + 1
  };
  void split(uint32_t node, std::vector<Bounds>& boxes);

  std::vector<TreeNode> nodes_;
  std::vector<uint32_t> order_;
};

}  // namespace greatx::scene
