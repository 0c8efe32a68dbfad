// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "core/random.h"
#include "scene/generator/city/city_plan.h"
#include "scene/generator/mesh/mesh_builder.h"

namespace greatx::scene::generator {

/// A building about its own origin. The origin stands at `position`, on the level of the pavement.
struct Building {
  MeshBuilder mesh;
  dvec3 position{0.0};
  double yaw = 0.0;
};

/// Makes the buildings of a block. They have footprints of several shapes on the lots of the block and are 8
/// to 45 m high, taller towards the centre. `first` is the number of the first of these buildings in the
/// city.
std::vector<Building> make_buildings(const CityPlan& plan, const Block& block, uint64_t seed, int first,
                                     RandomStream& random);

}  // namespace greatx::scene::generator
