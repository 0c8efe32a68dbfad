// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Defines the trees of boxes around the triangles of a scene, one for each body, for tracing without the
// driver (shaders/lib/tree_walk.glsl). They are made once. A driver's own structure on a CPU costs a gather
// for every word of a node, and some devices have none.
#pragma once

#include <cstdint>
#include <vector>

#include "scene/description/scene.h"

namespace greatx::scene {

/// Holds the words that shaders/shared/tree.h lays out. The same scene gives the same words.
struct SceneTrees {
  std::vector<uint32_t> words;  ///< quadruples, two at least
  uint32_t inner_nodes = 0, leaves = 0;
  /// Triangles with an area. Those without are never hit.
  uint32_t triangles = 0;
  /// Inner nodes on the longest path to a leaf; at most shared::tree_most_depth.
  uint32_t depth = 0;
};

/// Makes a tree for each body (scene/device/sah_tree.h). Boxes are rounded outwards to 1/65535 of the body's
/// extent. Throws UserError if the scene has more triangles than references can name.
SceneTrees make_scene_trees(const Scene& scene);

}  // namespace greatx::scene
