// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Reads all sources of a place. Data flow:
//
//   place.yaml ─► PlaceConfig ─┬─► maps: each reader returns MapContents, positions in degrees of WGS 84
//                              ├─► the area in degrees: as given, or the extent of sources
//                              ├─► terrain: samples of the area in degrees, heights above the vertical datum
//                              │     └─► origin ─► LocalFrame ─► HeightField (map_contents, height_file)
//                              ├─► maps in the frame, at the terrain's height, cut to the area (placement)
//                              └─► surface and pictures in the frame (height_file, picture_file)
//
// GDAL opens rasters, tables and CRS definitions; PROJ converts coordinates below it. libosmium reads the
// files of OpenStreetMap, because GDAL's driver for them gives no relation without members, no way without
// tags and no hint about nodes that are missing. CityJSON is read here (city_json.h): GDAL has no driver.
#pragma once

#include <functional>
#include <string>

#include "scene/place/config/place_config.h"
#include "scene/place/input/place_input.h"

namespace greatx::scene::place {

/// Hears one sentence per step.
using Progress = std::function<void(const std::string&)>;

/// Reads all sources. Throws UserError that names the file and the object if a source cannot be read, if it
/// has no coordinate system, or if nothing of the sources lies in the area. Faults that cost single objects
/// become findings.
PlaceInput read_place(const PlaceConfig& config, const Progress& progress = {});

}  // namespace greatx::scene::place
