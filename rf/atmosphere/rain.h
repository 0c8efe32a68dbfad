// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Computes the attenuation by rain by ITU-R P.838-3 (2005): gamma = k R^alpha dB/km, with R in mm/h. Drops
// are flattened, so that horizontal polarization loses more than vertical above about 2 GHz.
#pragma once

#include "core/dual.h"

namespace greatx::rf {

inline constexpr double rain_min_hz = 1e9, rain_max_hz = 1000e9;
constexpr bool rain_model_covers(double frequency_hz) {
  return frequency_hz >= rain_min_hz && frequency_hz <= rain_max_hz;
}

/// Holds k in (dB/km)/(mm/h)^alpha and alpha, for waves that travel horizontally.
template <typename R>
struct RainCoefficientsOf {
  R k_h = 0.0, alpha_h = 1.0;  ///< horizontal polarization
  R k_v = 0.0, alpha_v = 1.0;  ///< vertical polarization
};
using RainCoefficients = RainCoefficientsOf<double>;

/// Returns the coefficients by P.838-3, eq. 2 and 3 with Tables 1 to 4. Throws UserError outside 1 to 1000
/// GHz.
template <typename R = double>
RainCoefficientsOf<R> rain_coefficients(const Given<R>& frequency_hz);

/// Holds the attenuation of the two linear polarizations of one direction, dB/km.
template <typename R>
struct RainAttenuationOf {
  R h = 0.0;  ///< along phi_hat: horizontal
  R v = 0.0;  ///< along theta_hat: in the plane of the direction and the zenith
};
using RainAttenuation = RainAttenuationOf<double>;
/// Returns the specific attenuation by P.838-3, eq. 1, 4 and 5, for the tilts 0 and pi/2 of a direction with
/// cos^2(elevation) = `cos2_elevation`. The tilt is the angle of the polarization from the horizontal. Both
/// values are equal straight up and down. At any elevation and tilt the attenuation is at most the larger of
/// the two values at cos2_elevation = 1.
template <typename R = double>
RainAttenuationOf<R> rain_db_per_km(const RainCoefficientsOf<Given<R>>& coefficients, double rain_mm_h,
                                    const Given<R>& cos2_elevation);

}  // namespace greatx::rf
