// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "scene/generator/city/city_plan.h"
#include "scene/generator/mesh/mesh_builder.h"

namespace greatx::scene::generator {

/// The height of pavements and courtyards above the road (the kerb), metres.
inline constexpr double pavement_height_m = 0.15;

/// Adds streets and junctions at z = 0. Lane markings and zebra crossings are cut into the same plane instead
/// of lying over it, so that radio sees one flat road.
void add_streets(const CityPlan& plan, MeshBuilder& road, MeshBuilder& markings);

/// Adds the pavement of one block with its kerb, and the land inside the pavement with the material
/// `surface`.
void add_block_ground(const Block& block, int surface, MeshBuilder& pavement, MeshBuilder& courtyard);

/// Closes the ground with sides down to z = -1 m and an underside.
void add_base(const CityPlan& plan, MeshBuilder& base);

}  // namespace greatx::scene::generator
