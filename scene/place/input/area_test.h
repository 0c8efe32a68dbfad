// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Tells which features have a part in the area of a place. A feature that has one stays whole.
#pragma once

#include <span>

#include "scene/place/input/box.h"
#include "scene/place/input/place_input.h"

namespace greatx::scene::place {

/// Returns whether a point lies in a polygon by the rule of even and odd crossings, over all its rings. A
/// point on the boundary may count as either.
bool contains(const Polygon& polygon, const dvec2& point);

Box box_of(std::span<const dvec2> points);
/// Returns the box of all that a feature has, solids in plan.
Box box_of(const Feature& feature);

class AreaTest {
 public:
  explicit AreaTest(Polygon area);
  const Polygon& area() const { return area_; }
  const Box& box() const { return box_; }

  bool contains(const dvec2& point) const;
  /// Returns whether a part of the line lies in the area.
  bool meets_line(std::span<const dvec2> line, bool closed) const;
  /// Returns whether a part of the polygon lies in the area. This includes a polygon around the whole area.
  bool meets(const Polygon& polygon) const;
  /// Does the same for any feature; of a solid, for its faces in plan.
  bool meets(const Feature& feature) const;

 private:
  bool crosses(const dvec2& a, const dvec2& b) const;
  Polygon area_;
  Box box_;
};

}  // namespace greatx::scene::place
