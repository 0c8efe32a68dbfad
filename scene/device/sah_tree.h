// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Builds binary trees of boxes over triangles, by the surface area heuristic. They hold indices alone;
// scene/device/scene_trees.h writes them for shaders.
#pragma once

#include <array>
#include <cstdint>
#include <limits>
#include <vector>

#include "core/vec.h"

namespace greatx::scene {

/// Holds a box in fp32; min > max: nothing.
struct TreeBox {
  vec3 min{std::numeric_limits<float>::infinity()}, max{-std::numeric_limits<float>::infinity()};
  void add(const vec3& point) {
    min = glm::min(min, point);
    max = glm::max(max, point);
  }
  void add(const TreeBox& other) {
    min = glm::min(min, other.min);
    max = glm::max(max, other.max);
  }
  bool empty() const { return min.x > max.x; }
  vec3 center() const { return 0.5f * min + 0.5f * max; }
  /// Returns half of the surface, in fp64 so that no scene overflows it.
  double area() const {
    if (empty()) return 0.0;
    const dvec3 size = dvec3(max) - dvec3(min);
    return size.x * size.y + size.y * size.z + size.z * size.x;
  }
};

struct TreeTriangle {
  std::array<vec3, 3> corners;
  uint32_t triangle, primitive;  ///< indices into the scene
};

struct SahTree {
  struct Node {
    TreeBox box;
    uint32_t first = 0, count = 0;  ///< range of `triangles`; count 0: an inner node
    uint32_t left = 0, right = 0;   ///< children of an inner node
  };
  std::vector<Node> nodes;  ///< [0] is the root; children come after their parent; empty without triangles
  std::vector<TreeTriangle> triangles;  ///< in the order of the leaves
  uint32_t depth = 0;                   ///< inner nodes on the longest path to a leaf
  uint32_t inner_nodes = 0;
};

/// Makes a tree, split by the surface area heuristic with sixteen bins per axis (I. Wald, "On fast
/// construction of SAH-based bounding volume hierarchies", IEEE Symposium on Interactive Ray Tracing 2007).
/// At most shared::tree_most_in_leaf triangles share a leaf, and the depth is at most
/// shared::tree_most_depth. It uses all cores, and their number changes nothing.
SahTree make_sah_tree(std::vector<TreeTriangle> triangles);

}  // namespace greatx::scene
