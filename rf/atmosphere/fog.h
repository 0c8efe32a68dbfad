// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Computes the attenuation by fog and clouds by ITU-R P.840-8 (2019): Rayleigh's approximation for droplets
// below 0.1 mm.
#pragma once

#include "core/dual.h"

namespace greatx::rf {

inline constexpr double fog_max_hz = 200e9;  ///< droplets are small against the wavelength up to here
constexpr bool fog_model_covers(double frequency_hz) {
  return frequency_hz > 0.0 && frequency_hz <= fog_max_hz;
}

/// Returns K_l in (dB/km)/(g/m3): 0.819 f / (eps'' (1 + eta^2)) with eta = (2 + eps')/eps'' and the
/// double-Debye permittivity of liquid water (P.840-8, section 2, eq. 2 to 11). Throws UserError above 200
/// GHz.
template <typename R = double>
R fog_coefficient(const Given<R>& frequency_hz, double temperature_k);

/// Returns the specific attenuation gamma = K_l M in dB/km, where M = `fog_g_m3` is the density of liquid
/// water in g/m3 (P.840-8, eq. 1). Returns 0 without fog, at any frequency.
template <typename R = double>
R fog_db_per_km(const Given<R>& frequency_hz, double temperature_k, double fog_g_m3);

}  // namespace greatx::rf
