// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Operations on polygons in the plane (GEOS), and measures of them. Results have counter-clockwise outer
// rings and clockwise holes.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "scene/place/input/area_test.h"
#include "scene/place/input/place_input.h"

namespace greatx::scene::place {

/// Returns the area, positive for a counter-clockwise ring. Exact to rounding also far from the origin.
double signed_area(const Ring& ring);
double area(const Polygon& polygon);
double area(std::span<const Polygon> polygons);
double perimeter(const Polygon& polygon);
Box box_of(const Polygon& polygon);
Box box_of(std::span<const Polygon> polygons);

/// A polygon made valid.
struct Repaired {
  std::vector<Polygon> polygons;    ///< valid; empty if nothing with an area is left
  std::vector<std::string> faults;  ///< names of what was mended: "repeated corner", "crosses itself"
};
/// Makes a polygon valid: drops repeated corners and spikes, and divides it where it crosses itself. The
/// polygon covers what it covered under the even-odd rule.
Repaired repair(const Polygon& polygon);

/// Makes all polygons of an object valid and returns the pieces.
std::vector<Polygon> repaired(const std::vector<Polygon>& polygons);
/// Does the same and adds a finding for each fault; `what` names the polygons, "outline".
std::vector<Polygon> repaired(const std::vector<Polygon>& polygons, const std::string& object,
                              const std::string& what, std::vector<Finding>& findings);

std::vector<Polygon> unite(const std::vector<Polygon>& polygons);
std::vector<Polygon> subtract(const std::vector<Polygon>& from, const std::vector<Polygon>& what);
std::vector<Polygon> intersect(const std::vector<Polygon>& a, const std::vector<Polygon>& b);
/// Returns all points within `distance_m`; corners are mitred if `round` is false. Negative: shrinks.
std::vector<Polygon> grow(const std::vector<Polygon>& polygons, double distance_m, bool round = false);
/// Returns a band along a line. Ends are flat, corners are round with chords that deviate by less than 0.1 m
/// for widths up to 20 m.
std::vector<Polygon> band(const std::vector<dvec2>& line, double width_m);
/// Returns the part of the polygons where normal . p <= offset.
std::vector<Polygon> cut(const std::vector<Polygon>& polygons, const dvec2& normal, double offset);

}  // namespace greatx::scene::place
