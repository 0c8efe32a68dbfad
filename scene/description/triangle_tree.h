// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "scene/description/scene.h"

namespace greatx::scene {

/// Represents a tree of boxes around triangles, halved along their longest axis. It finds the triangles that
/// a segment may touch.
class TriangleTree {
 public:
  explicit TriangleTree(std::span<const FacetTriangle> triangles);
  /// Appends, ascending, the indices of the triangles whose box comes within `distance_m` of the segment.
  void near_segment(const dvec3& a, const dvec3& b, double distance_m, std::vector<uint32_t>& found) const;

 private:
  struct TreeNode {
    Bounds bounds;
    /// Of order_. With count 0 it is an inner node, whose children are at `first` and `first` + 1.
    uint32_t first = 0, count = 0;
  };
  void split(uint32_t node, std::vector<Bounds>& boxes);

  std::vector<TreeNode> nodes_;
  std::vector<uint32_t> order_;
};

}  // namespace greatx::scene
