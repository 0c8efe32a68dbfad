// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Reads CityJSON 1.0, 1.1 and 2.0 (https://www.cityjson.org/specs/2.0.1/).
//
// Buildings, their parts and installations become solids: SolidFaces of the highest level of detail below 3,
// in the boundary's own orientation. Everything that lies on the ground (roads, land use, water, plants,
// bridges) becomes an area in plan: the union of its surfaces, without the upright ones. Objects of other
// kinds are left out and counted.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "scene/place/source/map_contents.h"

namespace greatx::scene::place {

/// Returns whether the text is a JSON object with "type": "CityJSON".
bool is_city_json(std::string_view text);

/// Returns "EPSG:7415" for the forms that CityJSON allows: https://www.opengis.net/def/crs/EPSG/0/7415,
/// urn:ogc:def:crs:EPSG::7415, EPSG:7415; another text comes back as it is.
std::string crs_of_reference(const std::string& reference);

}  // namespace greatx::scene::place
