// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "core/random.h"
#include "scene/generator/city/city_plan.h"
#include "scene/generator/mesh/mesh_builder.h"

namespace greatx::scene::generator {

/// A place for tables, or for a fence, in front of a wall that looks towards `out`, in the city's frame.
struct CafePlace {
  dvec2 where{0.0}, out{0.0};
};

/// A building about its own origin. The origin stands at `position`, on the level of the pavement.
struct Building {
  MeshBuilder mesh;
  dvec3 position{0.0};
  double yaw = 0.0;
  std::string facade;  ///< name of the material of its walls
  std::vector<CafePlace> cafes;
  MeshBuilder scaffold;           ///< about the same origin; empty for most buildings
  std::vector<CafePlace> fences;  ///< in front of the scaffold
};

/// Makes the buildings of a block. They have footprints of several shapes on the lots of the block and are
/// 8 to 45 m high, taller towards the centre. Neighbours have different façades. `first` is the number of
/// the first of these buildings in the city.
std::vector<Building> make_buildings(const CityPlan& plan, const Block& block, uint64_t seed, int first,
                                     RandomStream& random);

}  // namespace greatx::scene::generator
