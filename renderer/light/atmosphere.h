// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// A clear sky seen from the ground: Rayleigh and aerosol scattering, ozone absorption, multiple scattering as an
// isotropic source. Coefficients and the multiple-scattering term: S. Hillaire, "A Scalable and Production Ready Sky
// and Atmosphere Rendering Technique", EGSR 2020, table 1 and section 5.5. The sun stands equally high over every
// point of the view, so that everything but the phase functions depends on the elevation alone.
#pragma once

#include <array>

#include "core/vec.h"

namespace greatx::render {

class Atmosphere {
 public:
  /// `turbidity`: vertical optical depth of air and aerosol over that of air alone, at 550 nm; `sun_elevation` rad, at
  /// least a degree; `ground_albedo` for the light that the ground throws back.
  Atmosphere(double turbidity, double sun_elevation, double ground_albedo);
  /// Per channel (linear Rec. 709), for a sun of illuminance 1 above the air. `sin_elevation` >= 0, of the direction;
  /// `cos_to_sun` of the angle between it and the sun.
  dvec3 radiance(double sin_elevation, double cos_to_sun) const;
  /// What the air leaves of the sun's light on the ground.
  const dvec3& sun_transmittance() const { return sun_on_ground_; }

 private:
  static constexpr int heights = 32, elevations = 96;
  struct Density {
    double air, aerosol, ozone;
  };
  Density density(double height) const;
  dvec3 extinction(const Density& d) const;
  dvec3 transmittance_to_top(double height, double sin_elevation) const;
  static dvec3 at_height(const std::array<dvec3, heights>& table, double height);
  void scatter_many_times(double ground_albedo);
  void integrate_views();

  double aerosol_scattering_, aerosol_extinction_, sun_sine_;
  dvec3 sun_on_ground_{0.0};
  std::array<dvec3, heights> sun_{};       ///< transmittance towards the sun, by height
  std::array<dvec3, heights> multiple_{};  ///< radiance of the light scattered twice and more, by height
  /// Integrals along the view by sqrt of the sine of its elevation: air, aerosol (each without its phase), multiple.
  std::array<dvec3, elevations> air_{}, aerosol_{}, rest_{};
};

}  // namespace greatx::render
