// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Reads heights, storeys, roofs and kinds of materials from the tags of a building.
#pragma once

#include <string>
#include <vector>

#include "scene/place/buildings/building.h"
#include "scene/place/buildings/roofs.h"
#include "scene/place/config/place_config.h"

namespace greatx::scene::place {

/// Numbers of one part, above the building's ground.
struct PartHeights {
  double bottom_m = 0.0;  ///< 0: on the ground
  double top_m = 0.0;
  double roof_m = 0.0;  ///< height of the roof, included in top_m
  RoofShape shape = RoofShape::flat;
  std::optional<double> direction_rad;
  bool across = false;
  int storeys = 1;
  Source from = Source::tag;
};

/// Says what is known of a part beside its tags.
struct PartContext {
  std::string label;          ///< for findings
  std::string use;            ///< of the building
  double half_width_m = 0.0;  ///< half the span of the roof
  bool convex = false;        ///< whether the footprint is convex and has four corners
  double area_m2 = 0.0;
  std::optional<double> surface_m;  ///< height of the surface model above the ground
};

PartHeights heights_of(const Feature& feature, const PartContext& context, const BuildingConfig& config,
                       std::vector<Finding>& findings);

/// Classes of materials (docs/places.md, "Materials"): by the material's tag, else by use, year and storeys,
/// where several would do by a draw from the object's id.
std::string facade_class_of(const Feature& feature, const BuildingConfig& config, int storeys);
std::string roof_class_of(const Feature& feature, RoofShape shape, const std::string& use);

}  // namespace greatx::scene::place
