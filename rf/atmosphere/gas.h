// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Computes the attenuation by oxygen and water vapour line by line by ITU-R P.676-13, Annex 1.
#pragma once

#include "core/dual.h"

namespace greatx::rf {

inline constexpr double gas_min_hz = 1e9, gas_max_hz = 1000e9;
constexpr bool gas_model_covers(double frequency_hz) {
  return frequency_hz >= gas_min_hz && frequency_hz <= gas_max_hz;
}

/// Returns the specific attenuation by gases, dB/km: 0.182 f (N''_oxygen + N''_water vapour) (P.676-13, eq.
/// 1), with 44 lines of oxygen, 35 lines of water vapour and the dry continuum. `dry_pressure_hpa` is the
/// pressure of dry air alone: the barometric pressure minus the vapour pressure. The result is finite at the
/// centre of every line, in dry air and in vacuum. Throws UserError outside 1 to 1000 GHz.
template <typename R = double>
R gas_db_per_km(const Given<R>& frequency_hz, double temperature_k, double dry_pressure_hpa,
                double water_vapour_g_m3);

}  // namespace greatx::rf
