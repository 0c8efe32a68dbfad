// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Defines the trees of boxes through which rays are traced without the driver: one over the triangles of each
// body, in one buffer that never changes (scene/device/scene_trees.h makes it), and one over the bodies that
// move, in a buffer of its own at each tick (scene/device/body_tree.h). lib/tree.glsl walks them. Both
// consist of quadruples of words, and indices count quadruples.
//
// The buffer of the bodies' triangles:
//   2 b, 2 b + 1      body b; body 0 never moves. Its frame: smallest coordinates (3 floats), reference to
//                     the root (tree_none: no triangles); size of a step of 1/65535 along each axis
//                     (3 floats), the body's owner (scene::Scene::owner_of)
//   inner nodes       two each, one a child: its box in steps of the body's frame (low x | low y, low z |
//                     high x, high y | high z; the first in the lower half of the word), reference to the
//                     child
//   triangles         three each: corner and triangle; corner and primitive; corner and facet. The highest
//                     bit of the primitive says that its material has holes.
//
// The buffer of the tick:
//   0, 1              the frame in local coordinates, as above; the last word is 0
//   inner nodes       as above
//
// A reference to an inner node is its index. A reference to a leaf of triangles is tree_leaf, the number of
// triangles, and the index of the first. A reference to a body is tree_leaf and the body's index.
#ifndef GREATX_SHADERS_SHARED_TREE_H
#define GREATX_SHADERS_SHARED_TREE_H
#include "scene.h"

GREATX_SHARED_BEGIN

const uint tree_leaf = 0x80000000u;
const uint tree_count_shift = 27u;
const uint tree_most_in_leaf = 15u;
const uint tree_most_quads = 1u << tree_count_shift;
const uint tree_none = 0xffffffffu;  // a reference to nothing
const uint tree_masked = 0x80000000u;
const uint tree_most_depth = 40u;
const uint tree_steps = 65535u;
const uint body_tree_head = 2u;         // quadruples before the inner nodes
const uint body_tree_most_depth = 20u;  // halves each time: enough for a million bodies

GREATX_SHARED_END

#endif
