// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// What is known of the thing under the cursor, from the ids of the main view's picture.
#pragma once

#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "sim/experiment/experiment.h"
#include "view/scene/scene_view.h"

namespace greatx::view {

/// Describes the surface that one pixel shows.
struct Picked {
  uint32_t instance = 0;    ///< index into the scene's instances
  uint32_t material = 0;    ///< index into the scene's materials
  dvec3 point{0.0};         ///< of the surface, world, m
  double distance_m = 0.0;  ///< from the camera along the ray
};

/// Returns the surface at column `x`, row `y` of the picture, or nothing where it shows the sky or where the
/// pixel lies outside. `origin` is the scene's.
std::optional<Picked> pick(const ScenePicture& picture, int x, int y, const dvec3& origin);

/// Rows of a table: a name, and a value with its unit.
using Facts = std::vector<std::pair<std::string, std::string>>;

/// Describes a picked surface: its instance, class, triangles, optical and radio material, position and
/// velocity. In a scene with a georeference it also gives latitude, longitude and height above the vertical
/// datum. The permittivity and the conductivity are those at `carrier_hz`. A material without a value
/// there says so in its row.
Facts facts_of(const Picked& picked, const sim::Experiment& experiment, const ScenePicture& picture,
               double carrier_hz);

}  // namespace greatx::view
