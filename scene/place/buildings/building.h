// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Defines buildings as columns: areas in the plan with a level bottom and a roof of planes.
//
//   Feature (tags, rings)  ─► make_buildings ─► Building { Part { area, bottom, roof faces } }
//   Building of all        ─► weld ─► Complex: one triangulation of the plan, layers in each region
//                          ─► faces: roofs, floors, walls, each once, corners shared exactly
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "scene/place/input/place_input.h"
#include "scene/place/plane/polygons.h"

namespace greatx::scene::place {

/// A plane z = height + dot(slope, p - at). It keeps its precision far from the origin.
struct Plane {
  dvec2 at{0.0};
  double height = 0.0;  ///< m at `at`
  dvec2 slope{0.0};     ///< rise per metre along x and y
  double z(const dvec2& p) const { return height + glm::dot(slope, p - at); }
  bool level() const { return slope == dvec2(0.0); }
};
/// Returns the plane through three points that are not in line in the plan.
Plane plane_through(const dvec3& a, const dvec3& b, const dvec3& c);

/// A piece of a roof.
struct RoofFace {
  std::vector<Polygon> area;
  Plane plane;
};

struct Part {
  std::vector<Polygon> area;   ///< valid polygons that do not overlap
  double bottom_z = 0.0;       ///< m in the scene's frame
  bool on_ground = true;       ///< whether it reaches down to the foundation, below the ground
  std::vector<RoofFace> roof;  ///< covers `area`
  double top_z = 0.0;          ///< highest point of the roof
  double eaves_z = 0.0;
  std::string roof_class;                                   ///< class of its material, "tiles"
  std::optional<std::array<unsigned char, 3>> roof_colour;  ///< sRGB
};

/// Says how a number came about.
enum class Source { tag, levels, solid, surface, assumed };

struct Building {
  std::string source, id;
  std::string use;  ///< value of `building`: "apartments", "house", "yes"
  std::string name;
  std::vector<Part> parts;
  double ground_z = 0.0;  ///< lowest ground at the outline, from which heights count
  double floor_height_m = 3.0;
  int storeys = 1;  ///< for the façade
  Source height_from = Source::tag;
  std::string facade_class;                                   ///< class of the walls' material, "brick"
  std::optional<std::array<unsigned char, 3>> facade_colour;  ///< sRGB
  std::vector<Polygon> read_outline;                          ///< as read, before neighbours were joined
  double plan_area_m2 = 0.0;                                  ///< of the source's footprint
  double plan_volume_m3 = 0.0;                                ///< of the columns, from the ground up
};

/// Returns what a building was made of, "source: id", for findings.
std::string label(const Building& building);

/// Returns the area that all parts cover together.
std::vector<Polygon> outline(const Building& building);

}  // namespace greatx::scene::place
