// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Maps the pixels of every lens to directions and back, in fp64.
#pragma once

#include <optional>
#include <vector>

#include "renderer/lens/lens.h"

namespace greatx::render {

/// Directions are in optical axes: x right, y down, z forward.
class LensRays {
 public:
  /// Throws UserError naming the camera if the lens has no inverse within the picture (Lens; for a fisheye:
  /// within its image circle, and the message says up to which radius the model holds), or if an
  /// equirectangular picture is not twice as wide as high.
  explicit LensRays(const LensGeometry& geometry);

  /// Returns the unit direction that pixel coordinates show; 0 outside the image circle.
  dvec3 ray(const dvec2& pixel) const;
  /// Returns the place in the picture's plane that shows a direction (of any length), whether within the
  /// picture or not. Nothing shows a direction outside the image circle, or behind a pinhole camera.
  std::optional<dvec2> pixel(const dvec3& direction) const;
  /// Returns [height, width] the directions of the pixels' centres.
  std::vector<dvec3> centers() const;
  /// Returns the pixels per radian around a direction: the root of the pixels per steradian. For an
  /// equirectangular picture it is the density at its equator.
  double density(const dvec3& direction) const;
  const LensGeometry& geometry() const { return geometry_; }

 private:
  void check_fisheye() const;

  LensGeometry geometry_;
  std::optional<Lens> lens_;  ///< pinhole models
  double fold_ = 0.0;         ///< fisheye: angle
};

}  // namespace greatx::render
