// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "scene/generator/city/city_plan.h"
#include "scene/generator/mesh/mesh_builder.h"

namespace greatx::scene::generator {

inline constexpr double pavement_height_m =
    0.15;  ///< kerb: pavements and courtyards lie this high above the road

/// Streets and junctions at z = 0. Lane markings and zebra crossings are cut into the same plane, not laid
/// over it: radio sees one flat road.
void add_streets(const CityPlan& plan, uint64_t seed, MeshBuilder& road, MeshBuilder& markings);

/// Pavement with its kerb, and the land within it (`surface`), of one block.
void add_block_ground(const Block& block, int surface, MeshBuilder& pavement, MeshBuilder& courtyard);

/// What closes the ground: sides down to z = -1 m and the underside.
void add_base(const CityPlan& plan, MeshBuilder& base);

}  // namespace greatx::scene::generator
