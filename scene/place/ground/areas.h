// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Areas on the ground: what covers it, from tags. Roads, paths and rails are bands about their lines.
#pragma once

#include <array>
#include <string>
#include <vector>

#include "scene/place/config/place_config.h"
#include "scene/place/plane/polygons.h"

namespace greatx::scene::place {

/// What covers the ground. The later one covers the earlier ones.
enum class Cover : uint32_t {
  base,  ///< where no source says anything
  residential,
  farmland,
  meadow,
  grass,
  wood,
  scrub,
  sand,
  rock,
  wetland,
  pitch,
  water,
  parking,
  square,
  rail,
  path,
  road,
};
inline constexpr size_t cover_count = 17;
const char* name_of(Cover cover);

struct GroundArea {
  Cover cover = Cover::base;
  std::vector<Polygon> polygons;
  Box box;
};

/// A bridge: a line that leaves the ground.
struct Bridge {
  std::string source, id;
  Cover cover = Cover::road;
  std::vector<dvec2> line;
  double width_m = 0.0;
  int layer = 1;
};

/// A line on the ground with its width, for traffic and markings.
struct GroundLine {
  std::string source, id;
  Cover cover = Cover::road;
  std::vector<dvec2> line;
  double width_m = 0.0;
};

struct GroundPlan {
  std::vector<GroundArea> areas;
  std::vector<GroundLine> lines;  ///< roads, paths, rails on the ground
  std::vector<Bridge> bridges;
};

/// Makes the areas. Widths: `width`; else `lanes` times 3.25 m; else by kind of road (docs/places.md).
GroundPlan ground_plan(const PlaceInput& input, const GroundConfig& config, std::vector<Finding>& findings);

/// Returns the cover of a feature that is an area, or nothing.
std::optional<Cover> cover_of_area(const Feature& feature);

}  // namespace greatx::scene::place
