// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "rf/atmosphere/fog.h"

#include "core/error.h"
#include "rf/atmosphere/water.h"

namespace greatx::rf {

template <typename R>
R fog_coefficient(const Given<R>& frequency_hz, double temperature_k) {
  if (!fog_model_covers(value_of(frequency_hz)))
    throw_user_error(
        "fog attenuation: expected a frequency of at most 200 GHz (ITU-R P.840-8), found {:g} GHz",
        value_of(frequency_hz) / 1e9);
  GREATX_CHECK(temperature_k > 0.0, "{} K", temperature_k);
  const auto [stored, lost] = water_permittivity<R>(frequency_hz, temperature_k);
  const R eta = (2.0 + stored) / lost;
  return 0.819 * (frequency_hz / 1e9) / (lost * (1.0 + eta * eta));
}

template <typename R>
R fog_db_per_km(const Given<R>& frequency_hz, double temperature_k, double fog_g_m3) {
  GREATX_CHECK(fog_g_m3 >= 0.0, "{} g/m3", fog_g_m3);
  return fog_g_m3 == 0.0 ? R(0.0) : fog_coefficient<R>(frequency_hz, temperature_k) * fog_g_m3;
}

template double fog_coefficient<double>(const double&, double);
template Dual fog_coefficient<Dual>(const Dual&, double);
template double fog_db_per_km<double>(const double&, double, double);
template Dual fog_db_per_km<Dual>(const Dual&, double, double);

}  // namespace greatx::rf
