// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Holds the reference's own hierarchy of boxes over triangles, facets and receivers (fp64, host). It is
// simple on purpose, so that it shares nothing with the code that it checks.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "core/vec.h"
#include "scene/description/scene.h"

namespace greatx::rf::reference {

/// Describes the half-space normal . x >= offset.
struct HalfSpace {
  dvec3 normal{0.0};
  double offset = 0.0;
  double depth(const dvec3& point) const { return glm::dot(normal, point) - offset; }
};

class BoxTree {
 public:
  explicit BoxTree(const std::vector<scene::Bounds>& boxes);

  /// Calls visit(index) for every box (and perhaps some more) of which a part lies in each half-space. The
  /// order depends on the boxes alone.
  template <typename Visit>
  void within(std::span<const HalfSpace> half_spaces, const Visit& visit) const {
    uint32_t stack[64], size = 0;
    if (!nodes_.empty()) stack[size++] = 0;
    while (size > 0) {
      const Node& node = nodes_[stack[--size]];
      if (outside(node, half_spaces)) continue;
      if (node.count > 0) {
        for (uint32_t i = 0; i < node.count; ++i) visit(items_[node.first + i]);
      } else {
        stack[size++] = node.first + 1;
        stack[size++] = node.first;
      }
    }
  }

  /// Calls visit(index) for every box (and perhaps some more) that the segment a-b touches.
  template <typename Visit>
  void along(const dvec3& a, const dvec3& b, const Visit& visit) const {
    uint32_t stack[64], size = 0;
    if (!nodes_.empty()) stack[size++] = 0;
    while (size > 0) {
      const Node& node = nodes_[stack[--size]];
      if (missed(node, a, b)) continue;
      if (node.count > 0) {
        for (uint32_t i = 0; i < node.count; ++i) visit(items_[node.first + i]);
      } else {
        stack[size++] = node.first + 1;
        stack[size++] = node.first;
      }
    }
  }

 private:
  struct Node {
    dvec3 center{0.0}, half{0.0};
    uint32_t first = 0;  ///< first item; for an inner node the first child, which the other child follows
    uint32_t count = 0;  ///< number of items; 0 for an inner node
  };
  static bool outside(const Node& node, std::span<const HalfSpace> half_spaces);
  static bool missed(const Node& node, const dvec3& a, const dvec3& b);
  void split(uint32_t node, uint32_t first, uint32_t count, const std::vector<scene::Bounds>& boxes);

  std::vector<Node> nodes_;
  std::vector<uint32_t> items_;
};

}  // namespace greatx::rf::reference
