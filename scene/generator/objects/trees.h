// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Makes trees with the foot at the origin and z up.
#pragma once

#include "scene/generator/mesh/mesh_builder.h"

namespace greatx::scene::generator {

inline constexpr int tree_species = 6;  ///< linden, maple, oak, plane, Lombardy poplar, copper beech

/// Makes a broad-leaved tree 6 to 11 m high. `kind` is below tree_species. `shape` (any number) varies the
/// boughs. The crown is one closed body of 48 triangles with gaps between boughs.
MeshBuilder make_tree(int kind, int shape);
/// Makes a spruce some 10 m high.
MeshBuilder make_conifer();

}  // namespace greatx::scene::generator
