// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// The most that each part of the air can take over a distance, whatever a path's directions and polarization.
// An effect whose bound is within the tolerance may stay off. Each throws UserError where its model does not
// cover the frequency (gas_model_covers, rain_model_covers, fog_model_covers, foliage_model_covers tell
// beforehand).
#pragma once

#include "rf/atmosphere/weather.h"
#include "scene/material/material.h"

namespace greatx::rf {

/// dB over `distance_m`; exact, for gas knows no direction.
double most_gas_db(const Weather& weather, double frequency_hz, double distance_m);
/// dB over `distance_m`: the larger of horizontal and vertical polarization, travelling horizontally.
double most_rain_db(const Weather& weather, double frequency_hz, double distance_m);
/// dB over `distance_m`; exact.
double most_fog_db(const Weather& weather, double frequency_hz, double distance_m);
/// dB of any depth up to `depth_m`, with the step down at 14 m in mind.
double most_foliage_db(const scene::Foliage& foliage, double frequency_hz, double depth_m);

}  // namespace greatx::rf
