// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Makes buildings of the features that are buildings: heights, roofs and classes of materials from tags or by
// stated rules, parts under their buildings, faults mended. Every rule that stands in for a tag is a Finding.
#pragma once

#include <functional>
#include <vector>

#include "scene/place/buildings/building.h"
#include "scene/place/config/place_config.h"

namespace greatx::scene::place {

/// Height of the ground at a place, m in the scene's frame.
using GroundAt = std::function<double(const dvec2&)>;

/// The rules, in this order. Height: `height`; else `building:levels` times the floor height; else the median
/// of `surface` over the footprint; else a uniform draw between the bounds for the kind of building. The
/// height of a roof: `roof:height`; else `roof:angle`; else `roof:levels` times 2.5 m; else the smaller of
/// 35 degrees and 0.45 of the building's height. Heights count from the lowest ground at the outline.
/// Simple 3D Buildings (OpenStreetMap wiki): an outline with parts is not built where parts cover it. What
/// they leave uncovered is built up to the top of the lowest part.
std::vector<Building> make_buildings(const PlaceInput& input, const BuildingConfig& config,
                                     const GroundAt& ground, std::vector<Finding>& findings);

/// Returns whether a feature is a building or a part of one.
bool is_building(const Feature& feature);
bool is_building_part(const Feature& feature);

/// Returns the parts of a solid: an area for every face that looks upwards, with its plane. `bottom_z` gets
/// the lowest corner.
std::vector<RoofFace> roof_of_solid(const std::vector<SolidFace>& faces, double& bottom_z);
/// Returns the volume that a solid's faces enclose after its open floor is closed at its lowest corner, m^3.
double volume_of_solid(const std::vector<SolidFace>& faces);

}  // namespace greatx::scene::place
