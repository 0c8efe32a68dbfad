// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Defines a clear sky seen from the ground, by day and in twilight. The model has Rayleigh and aerosol
// scattering and ozone over a round Earth whose shadow falls into its air. Light scattered twice and more is
// an isotropic source: S. Hillaire, "A Scalable and Production Ready Sky and Atmosphere Rendering Technique",
// EGSR 2020, section 5.5. The spectrum has eight bands. Refraction is left out.
#pragma once

#include <vector>

#include "core/vec.h"

namespace greatx::render {

/// Represents the sky for a light (sun, moon) of illuminance 1 and the sun's colour above the air. Colours
/// are linear Rec. 709.
class Atmosphere {
 public:
  /// `turbidity` is the vertical optical depth of air and aerosol over that of air alone, at 550 nm.
  /// `elevation` is that of the light, rad. Below -11 degrees, where the first order has almost left the sky,
  /// the sky keeps the look that it has there. `ground_albedo` gives the light that the ground throws back
  /// into the air.
  Atmosphere(double turbidity, double elevation, double ground_albedo);

  /// Returns the radiance from a unit direction with z >= 0. The axes have z up and the light above (or
  /// below) the positive x axis.
  dvec3 radiance(const dvec3& direction) const;
  /// The illuminance of all directions on level ground.
  const dvec3& sky_illuminance() const { return sky_illuminance_; }
  /// The illuminance of a surface on the ground that faces the light. A light below the horizon counts as if
  /// it were on the horizon.
  const dvec3& direct_illuminance() const { return direct_illuminance_; }

 private:
  static constexpr int elevations = 56, azimuths = 13;
  struct Cell {
    dvec3 air, aerosol, rest;  ///< integrals along the view; the first two without their phase functions
  };
  dvec3 light_;  ///< unit, to the light
  /// [elevations, azimuths], by the square root of the sine, and from the light's azimuth.
  std::vector<Cell> cells_;
  dvec3 sky_illuminance_{0.0}, direct_illuminance_{0.0};
};

}  // namespace greatx::render
