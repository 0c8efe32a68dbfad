// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Defines the tree of the static world, in one buffer of quadruples of words (scene/device/static_tree.h
// makes it, lib/tree.glsl walks it). Indices count quadruples.
//
//   0                 frame: smallest coordinates (3 floats), reference to the root
//   1                 frame: size of a step of 1/65535 along each axis (3 floats), bodies that move
//   2 ...             two for each body that moves and has triangles: a sphere in its own frame that holds
//                     them (centre, radius); the body, its owner, 0, 0
//   inner nodes       two each, one a child: its box in steps (low x | low y, low z | high x, high y |
//                     high z; the first in the lower half of the word), reference to the child
//   triangles         three each: corner and triangle; corner and primitive; corner and facet. The highest
//                     bit of the primitive says that its material has holes.
//
// A reference to an inner node is its index. A reference to a leaf is tree_leaf, the number of triangles, and
// the index of the first.
#ifndef GREATX_SHADERS_SHARED_TREE_H
#define GREATX_SHADERS_SHARED_TREE_H
#include "scene.h"

GREATX_SHARED_BEGIN

const uint tree_bodies = 2u;
const uint tree_leaf = 0x80000000u;
const uint tree_count_shift = 27u;
const uint tree_most_in_leaf = 15u;
const uint tree_most_quads = 1u << tree_count_shift;
const uint tree_none = 0xffffffffu;  // a reference to nothing
const uint tree_masked = 0x80000000u;
const uint tree_most_depth = 40u;
const uint tree_steps = 65535u;

GREATX_SHARED_END

#endif
