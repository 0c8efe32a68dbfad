// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Makes roofs as planes over parts of a footprint. A roof over a convex footprint is the lower envelope of
// planes, z = min_i plane_i; a roof over several wings is the upper envelope of the wings' roofs.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "scene/place/buildings/building.h"

namespace greatx::scene::place {

enum class RoofShape {
  flat,
  skillion,
  gabled,
  half_hipped,
  hipped,
  pyramidal,
  gambrel,
  mansard,
  saltbox,
  round,
  dome
};
/// Returns the shape that a value of OpenStreetMap's roof:shape names, or nothing. Values without a shape of
/// their own are mapped to the nearest one: "cone" and "onion", for instance.
std::optional<RoofShape> roof_shape(const std::string& value);
const char* name_of(RoofShape shape);

/// A rectangle in the plan.
struct Rectangle {
  dvec2 center{0.0}, along{1.0, 0.0};  ///< unit vector of the longer side
  dvec2 half{0.0};                     ///< half lengths along and across, half.x >= half.y
};
/// Returns the rectangle of least area around the points (rotating calipers over the convex hull).
Rectangle smallest_rectangle(const std::vector<dvec2>& points);

struct RoofOptions {
  RoofShape shape = RoofShape::flat;
  double eaves_z = 0.0, ridge_z = 0.0;
  std::optional<double> direction_rad;  ///< from x towards y, in which the roof falls (skillion, saltbox)
  bool across = false;                  ///< the ridge runs across the longer side
};

/// Returns the wings of a footprint whose edges have two directions at right angles: rectangles that cover
/// it, the largest first. Returns nothing if more than 5 % of the outline deviates by more than 8 degrees, or
/// if the footprint has more than 24 edges.
std::vector<Rectangle> wings(const Polygon& footprint);

/// Walls that are this near lie on one line of a wing.
inline constexpr double same_line_m = 0.25;

/// Returns faces that cover the footprint. Their highest point is at `ridge_z`. Roofs whose wings or
/// rectangle fit the walls badly may end below `eaves_z` there.
std::vector<RoofFace> make_roof(const Polygon& footprint, const RoofOptions& options);

/// Returns the part of the area over which each of the planes is the lowest.
std::vector<RoofFace> lower_envelope(const std::vector<Polygon>& area, const std::vector<Plane>& planes);

}  // namespace greatx::scene::place
