// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "scene/place/assemble/picture_cover.h"
#include "scene/place/assemble/place_mesh.h"
#include "scene/place/buildings/complex.h"
#include "scene/place/config/place_config.h"
#include "scene/place/surfaces/material_table.h"

namespace greatx::scene::place {

/// Makes the mesh of every building: its walls with façades, its roofs and floors. Walls along one straight
/// line of a building are one façade, which gets a whole number of bays; storeys are as high as the walls
/// over their number. Walls beside a neighbour are blind, and party walls have a material of their own.
std::vector<PlaceMesh> building_meshes(const std::vector<Building>& buildings, const Complex& complex,
                                       const BuildingConfig& config, const PictureCover& pictures,
                                       MaterialTable& table);

}  // namespace greatx::scene::place
