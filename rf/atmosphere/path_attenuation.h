// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Computes the attenuation of a path by the air. The specific attenuation is computed once per channel, at
// the carrier. The air changes amplitudes only; delay and phase remain those of vacuum.
#pragma once

#include "core/vec.h"
#include "rf/antenna/field_vector.h"
#include "rf/atmosphere/rain.h"
#include "rf/atmosphere/weather.h"

namespace greatx::rf {

/// Selects the parts of the weather that attenuate.
struct WeatherEffects {
  bool gas = true, rain = true, fog = true;
};

/// Returns the amplitude factor 10^(-gamma d / 20), with gamma in dB/km and d in m. The result underflows to
/// 0 over huge distances.
template <typename R = double>
R amplitude(const Given<R>& db_per_km, const Given<R>& distance_m);

/// Holds the amplitude factors of the two linear polarizations of a direction.
template <typename R>
struct PolarizedAmplitudeOf {
  R theta = 1.0;  ///< along theta_hat: vertical polarization
  R phi = 1.0;    ///< along phi_hat: horizontal polarization
};
using PolarizedAmplitude = PolarizedAmplitudeOf<double>;

/// Holds the specific attenuation at one frequency, dB/km.
template <typename R>
struct PathAttenuationOf {
  R gas = 0.0;
  R rain_h = 0.0, rain_v = 0.0;  ///< for waves that travel horizontally
  R fog = 0.0;
  RainCoefficientsOf<R> rain;
  double rain_mm_h = 0.0;

  bool none() const { return gas == 0.0 && rain_mm_h == 0.0 && fog == 0.0; }
  /// Returns the part that does not depend on polarization, dB/km: gas and fog.
  R isotropic() const { return gas + fog; }
  /// Returns the amplitude factors of gas, rain and fog together over `distance_m` in the unit vector
  /// `direction`. Theta_hat and phi_hat of the direction are the vertical and horizontal polarization of
  /// P.838-3 (tilts of 90 and 0 degrees) at the elevation of the direction.
  PolarizedAmplitudeOf<R> of(const Vec3Of<R>& direction, const R& distance_m) const;
  /// Returns the field after `distance_m` in `direction`. The component along theta_hat and the component
  /// along phi_hat are each attenuated by their own factor. Applied segment by segment, this is all that
  /// P.838-3 specifies; it does not treat canted drops and the differential phase, which would couple the two
  /// components. A single factor for a whole path (the mean of rain_h and rain_v) would be wrong by at most
  /// |rain_h - rain_v| / 2 per kilometre: 0.37 dB/km in 25 mm/h at 28 GHz.
  FieldVectorOf<R> after(const FieldVectorOf<R>& field, const Vec3Of<R>& direction,
                         const R& distance_m) const;
};
using PathAttenuation = PathAttenuationOf<double>;
extern template struct PathAttenuationOf<double>;
extern template struct PathAttenuationOf<Dual>;

/// Returns the specific attenuation of the selected effects at `frequency_hz`. Rain and fog of 0 contribute
/// nothing at any frequency. Throws UserError if a selected effect does not cover the frequency: gas and rain
/// cover 1 to 1000 GHz, fog covers up to 200 GHz.
template <typename R = double>
PathAttenuationOf<R> path_attenuation(const Weather& weather, const Given<R>& frequency_hz,
                                      const WeatherEffects& effects = {});

}  // namespace greatx::rf
