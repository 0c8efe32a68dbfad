// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "rf/atmosphere/fog.h"

#include "core/error.h"

namespace greatx::rf {

double fog_coefficient(double frequency_hz, double temperature_k) {
  if (!fog_model_covers(frequency_hz))
    throw_user_error(
        "fog attenuation: expected a frequency of at most 200 GHz (ITU-R P.840-8), found {:g} GHz",
        frequency_hz / 1e9);
  GREATX_CHECK(temperature_k > 0.0, "{} K", temperature_k);
  const double f = frequency_hz / 1e9;
  const double warm = 300.0 / temperature_k - 1.0;  // theta - 1
  const double eps0 = 77.66 + 103.3 * warm, eps1 = 0.0671 * eps0, eps2 = 3.52;
  // Principal and secondary relaxation frequency, GHz.
  const double fp = 20.20 - 146.0 * warm + 316.0 * warm * warm, fs = 39.8 * fp;
  const double x = f / fp, y = f / fs;
  const double lost = x * (eps0 - eps1) / (1.0 + x * x) + y * (eps1 - eps2) / (1.0 + y * y);   // eps''
  const double stored = (eps0 - eps1) / (1.0 + x * x) + (eps1 - eps2) / (1.0 + y * y) + eps2;  // eps'
  const double eta = (2.0 + stored) / lost;
  return 0.819 * f / (lost * (1.0 + eta * eta));
}

double fog_db_per_km(double frequency_hz, double temperature_k, double fog_g_m3) {
  GREATX_CHECK(fog_g_m3 >= 0.0, "{} g/m3", fog_g_m3);
  return fog_g_m3 == 0.0 ? 0.0 : fog_coefficient(frequency_hz, temperature_k) * fog_g_m3;
}

}  // namespace greatx::rf
