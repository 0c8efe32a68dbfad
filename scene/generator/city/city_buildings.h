// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "core/random.h"
#include "scene/generator/city/city_plan.h"
#include "scene/generator/mesh/mesh_builder.h"

namespace greatx::scene::generator {

/// A building about its own origin, which stands at `position` on the pavement's level.
struct Building {
  MeshBuilder mesh;
  dvec3 position{0.0};
  double yaw = 0.0;
};

/// The buildings of a block: footprints of several shapes on its lots, 8 to 45 m high, taller towards the
/// centre. `first` is the number of the first of them in the city.
std::vector<Building> make_buildings(const CityPlan& plan, const Block& block, uint64_t seed, int first,
                                     RandomStream& random);

}  // namespace greatx::scene::generator
