// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Builds the scene of a place from its input.
//
//   PlaceInput ─► GroundPlan ─► TerrainMesh ──┐
//              ─► Building  ─► Complex ───────┼─► SceneWriter ─► glTF, georeferenced
//              ─► ObjectPlan ─────────────────┘
//              ─► PlaceReport: counts, findings, areas and volumes against the source
#pragma once

#include <cstddef>
#include <functional>
#include <map>
#include <string>
#include <vector>

#include "scene/place/assemble/objects.h"
#include "scene/place/buildings/building.h"
#include "scene/place/config/place_config.h"
#include "scene/place/ground/areas.h"
#include "scene/place/input/place_input.h"

namespace greatx::scene::place {

/// What was built, in numbers, and all that was found on the way.
struct PlaceReport {
  std::string name;
  Georeference reference;
  Box rectangle;  ///< of the ground
  size_t buildings = 0, parts = 0, courts = 0;
  std::map<std::string, size_t> heights;  ///< number of buildings by what their height comes from
  double source_area_m2 = 0.0, built_area_m2 = 0.0;
  double source_volume_m3 = 0.0, built_volume_m3 = 0.0;
  double most_welded_m = 0.0;  ///< largest change of a height where surfaces nearly meet
  double most_moved_m = 0.0;   ///< largest distance of a corner of an outline from what was built
  size_t triangles = 0;
  std::map<std::string, size_t> triangles_by_kind;  ///< "buildings", "ground", "objects"
  std::map<std::string, double> cover_m2;           ///< area of the ground by cover
  std::map<std::string, size_t> objects;            ///< by kind
  size_t terrain_samples = 0;
  double terrain_error_m = 0.0;  ///< largest, at the samples
  size_t ground_filled = 0;      ///< corners of the ground without data, which got the nearest height
  std::vector<Finding> findings;
  std::vector<std::string> licences;
  std::vector<std::pair<std::string, std::vector<std::string>>> materials;  ///< the table
};

/// The scene and what a picture of it from above needs.
struct BuiltPlace {
  std::vector<std::byte> glb;
  PlaceReport report;
  std::vector<Building> buildings;
  GroundPlan ground;
};

/// Gets the name of the step and its share of the whole, 0 to 1.
using PlaceProgress = std::function<void(const std::string& step, double share)>;

/// Builds a place. The same input gives the same bytes. Throws UserError if there is nothing to build or the
/// place is too large.
BuiltPlace build_place(const PlaceInput& input, const PlaceConfig& config,
                       const PlaceProgress& progress = {});

}  // namespace greatx::scene::place
