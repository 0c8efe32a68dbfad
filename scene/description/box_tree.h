// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Defines a tree of boxes for searches on the host: triangles near a segment, facets within a beam, pieces of
// a facet within a tube. These trees have their own layout and are elsewhere: EchoTracer (eight children side
// by side), TargetImages (points, four side by side), and SahTree (for shaders).
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "scene/description/scene.h"

namespace greatx::scene {

/// A binary tree of boxes. A node is halved by the centres of its boxes, along the axis on which the centres
/// are farthest apart.
class BoxTree {
 public:
  BoxTree() = default;
  explicit BoxTree(std::span<const Bounds> boxes);
  bool empty() const { return nodes_.empty(); }

  /// Calls visit(index) for every box in each leaf for which outside(box) is false for the boxes of the leaf
  /// and of all nodes above it. These are all boxes that are not outside, and some more. Their order depends
  /// on the boxes alone. If visit returns true, the search ends and visit_until returns true.
  template <typename Outside, typename Visit>
  bool visit_until(const Outside& outside, const Visit& visit) const {
    uint32_t stack[64], size = 0;
    if (!nodes_.empty()) stack[size++] = 0;
    while (size > 0) {
      const Node& node = nodes_[stack[--size]];
      if (outside(node.bounds)) continue;
      if (node.count == 0) {
        stack[size++] = node.first;
        stack[size++] = node.first + 1;
        continue;
      }
      for (uint32_t i = node.first; i < node.first + node.count; ++i)
        if (visit(order_[i])) return true;
    }
    return false;
  }

  /// Appends the boxes that visit_until would visit, ascending.
  template <typename Outside>
  void gather(const Outside& outside, std::vector<uint32_t>& found) const {
    const size_t already = found.size();
    visit_until(outside, [&](uint32_t index) {
      found.push_back(index);
      return false;
    });
    sort_from(found, already);
  }

 private:
  struct Node {
    Bounds bounds;
    /// A leaf's range of order_. An inner node has count 0, and its children are the nodes `first` and
    /// `first` + 1.
    uint32_t first = 0, count = 0;
  };
  void split(uint32_t node, std::span<const Bounds> boxes);
  static void sort_from(std::vector<uint32_t>& found, size_t already);

  std::vector<Node> nodes_;
  std::vector<uint32_t> order_;
};

}  // namespace greatx::scene
