// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// What the air takes from a path: worked out once per channel, at its carrier. Amplitudes only: delay and
// phase stay those of vacuum.
#pragma once

#include "core/vec.h"
#include "rf/antenna/field_vector.h"
#include "rf/atmosphere/rain.h"
#include "rf/atmosphere/weather.h"

namespace greatx::rf {

/// Which parts of the weather count.
struct WeatherEffects {
  bool gas = true, rain = true, fog = true;
};

/// 10^(-gamma d / 20), gamma in dB/km, d in m; underflows to 0 over huge distances.
double amplitude(double db_per_km, double distance_m);

/// Amplitude factors of the two linear polarizations of a direction.
struct PolarizedAmplitude {
  double theta = 1.0;  ///< along theta_hat: vertical polarization
  double phi = 1.0;    ///< along phi_hat: horizontal polarization
};

/// Specific attenuation at one frequency, dB/km.
struct PathAttenuation {
  double gas = 0.0;
  double rain_h = 0.0, rain_v = 0.0;  ///< of waves that travel horizontally
  double fog = 0.0;
  RainCoefficients rain;
  double rain_mm_h = 0.0;

  bool none() const { return gas == 0.0 && rain_mm_h == 0.0 && fog == 0.0; }
  /// What does not depend on polarization: gas and fog.
  double isotropic() const { return gas + fog; }
  /// Of `distance_m` in the unit `direction`, all three together. Theta_hat and phi_hat of the direction are
  /// the vertical and horizontal polarization of P.838-3 (tilts of 90 and 0 degrees) at the direction's
  /// elevation.
  PolarizedAmplitude of(const dvec3& direction, double distance_m) const;
  /// The field after `distance_m` in `direction`: its components along theta_hat and phi_hat attenuated each
  /// by its own. Segment by segment this is all that P.838-3 says; canted drops and the differential phase,
  /// which it does not treat, would couple the two.
  /// One factor for a whole path instead (the mean of rain_h and rain_v) is off by at most |rain_h - rain_v|
  /// / 2 a kilometre: 0.37 dB/km in 25 mm/h at 28 GHz.
  FieldVector after(const FieldVector& field, const dvec3& direction, double distance_m) const;
};

/// The effects that are on, at `frequency_hz`. Rain and fog of 0 cost nothing at any frequency. Throws
/// UserError where an effect that is on does not cover the frequency: gas and rain 1 to 1000 GHz, fog up to
/// 200 GHz.
PathAttenuation path_attenuation(const Weather& weather, double frequency_hz,
                                 const WeatherEffects& effects = {});

}  // namespace greatx::rf
