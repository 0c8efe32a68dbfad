// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "rf/config/echo_options.h"
#include "sim/plan/effect_planner.h"

namespace greatx::sim {

/// Decides the effects of radars.
void plan_radar(EffectPlan& plan, const Planner& planner, const Scenario& scenario,
                const scene::Scene& scene);

/// Returns the attenuation by gases, rain and fog at a carrier, dB/km; parts whose recommendation does not
/// cover the carrier count nothing. Rain has the mean of both polarizations for horizontal paths: wrong by at
/// most half of their difference (0.4 dB/km in 25 mm/h at 28 GHz).
double radar_air_db_per_km(const Environment& environment, double carrier_hz);

/// Returns what raindrops send back at a carrier (rf/atmosphere/rain_backscatter.h). Nothing without rain.
rf::RainEchoes radar_rain(const Environment& environment, double carrier_hz);

}  // namespace greatx::sim
