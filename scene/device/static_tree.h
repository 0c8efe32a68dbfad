// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Defines a tree of boxes around the triangles of the static world, for tracing without the driver
// (shaders/lib/tree.glsl). The driver's own structure on a CPU costs a gather for every word of a node.
#pragma once

#include <cstdint>
#include <vector>

#include "scene/description/scene.h"

namespace greatx::scene {

/// Holds the words that shaders/shared/tree.h lays out. The same scene gives the same words.
struct StaticTree {
  std::vector<uint32_t> words;  ///< quadruples, never empty
  uint32_t inner_nodes = 0, leaves = 0;
  /// Triangles of body 0 with an area. Triangles without area are never hit.
  uint32_t triangles = 0;
  /// Inner nodes on the longest path to a leaf; at most shared::tree_most_depth.
  uint32_t depth = 0;
};

/// Makes a binary tree, split by the surface area heuristic with sixteen bins per axis (I. Wald, "On fast
/// construction of SAH-based bounding volume hierarchies", IEEE Symposium on Interactive Ray Tracing 2007).
/// Boxes are rounded outwards to 1/65535 of the scene's extent. It uses all cores.
StaticTree make_static_tree(const Scene& scene);

}  // namespace greatx::scene
