// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Describes the air that all paths of a channel cross. It is the same everywhere and at all times of a run.
#pragma once

namespace greatx::rf {

struct Weather {
  double temperature_k = 288.15;      ///< > 0
  double dry_pressure_hpa = 1013.25;  ///< pressure of dry air without the vapour pressure (ITU-R P.676); >= 0
  double water_vapour_g_m3 = 7.5;     ///< >= 0
  double rain_mm_h = 0.0;             ///< >= 0
  double fog_g_m3 = 0.0;              ///< liquid water in droplets below 0.1 mm; >= 0
};

/// Returns the partial pressure of water vapour, hPa: e = rho T / 216.7 (ITU-R P.676-13, eq. 4).
constexpr double vapour_pressure_hpa(double water_vapour_g_m3, double temperature_k) {
  return water_vapour_g_m3 * temperature_k / 216.7;
}

}  // namespace greatx::rf
