// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Puts places on the Earth into the scene's frame.
#pragma once

#include "core/geodesy.h"
#include "scene/place/input/place_input.h"

namespace greatx::scene::place {

/// A point of a map has no height of its own, but its x and y depend on it: at 10 km from the origin they
/// move 1.6 mm per metre of height. Points of maps therefore take the terrain's height.
class Placement {
 public:
  /// `terrain` may be empty, or grow later; it outlives this.
  Placement(const Georeference& reference, const HeightField& terrain);
  const LocalFrame& frame() const { return frame_; }

  /// Returns the place of (longitude, latitude) in degrees on the terrain, or at the height of the origin
  /// where there is none. x and y are those of the terrain's point to 1 mm up to slopes of 45 degrees and 20
  /// km.
  dvec2 on_ground(const dvec2& degrees) const;
  /// Returns the inverse: (longitude, latitude) of the ground at x and y.
  dvec2 degrees_of(const dvec2& local) const;
  /// Returns the place at a height above the vertical datum.
  dvec3 at_height(const dvec2& degrees, double height_m) const;
  /// Converts all positions of a feature from degrees.
  void place(Feature& feature) const;
  /// Returns the height of the ground above the vertical datum.
  double ground_height_m(const dvec2& local) const;

 private:
  LocalFrame frame_;
  const HeightField& terrain_;
  double origin_height_m_;  ///< above the vertical datum
};

}  // namespace greatx::scene::place
