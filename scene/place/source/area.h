// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Finds the area of a place on the Earth: as given, or the extent of sources.
#pragma once

#include "scene/place/config/place_config.h"
#include "scene/place/source/map_contents.h"
#include "scene/place/source/placement.h"

namespace greatx::scene::place {

/// The area in degrees; x is the longitude, perhaps beyond 180 where the area crosses the antimeridian.
struct DegreesArea {
  Polygon polygon;
  Box box;
  dvec2 centre() const { return (box.low + box.high) / 2.0; }
};

/// Returns the area that place.yaml gives, or nothing if it is the extent of sources.
std::optional<DegreesArea> given_area(const PlaceConfig& config);
/// Returns the rectangle of an extent, 1e-5 degrees (1 m) larger on each side. Throws UserError if it is
/// wider than 2 degrees or empty.
DegreesArea area_of_extent(const Box& extent, const std::string& where);

/// Returns the area in the frame. Parallels are curved there, so that edges get corners every 500 m, which
/// keeps each within 1 cm of the parallel up to latitudes of 60 degrees.
Polygon area_in_frame(const DegreesArea& area, const Placement& placement);

/// Returns a hint if the extent meets the area once latitude and longitude change places, or an empty text.
std::string swapped_hint(const Box& extent, const Box& area);

/// Returns "latitude 52.01070 to 52.01370, longitude 4.36200 to 4.36960" for messages.
std::string extent_text(const Box& degrees);

}  // namespace greatx::scene::place
