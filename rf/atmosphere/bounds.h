// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Computes upper bounds of the attenuation by each part of the air over a distance, for any direction and
// polarization of a path. An effect whose bound lies within the tolerance may stay off. Each function throws
// UserError if its model does not cover the frequency; gas_model_covers, rain_model_covers and
// fog_model_covers tell this in advance.
#pragma once

#include "rf/atmosphere/weather.h"

namespace greatx::rf {

/// Returns the attenuation by gases over `distance_m`, dB. The value is exact because gas attenuation does
/// not depend on the direction.
double most_gas_db(const Weather& weather, double frequency_hz, double distance_m);
/// Returns the larger attenuation by rain of horizontal and vertical polarization over `distance_m`, dB, for
/// a horizontal path.
double most_rain_db(const Weather& weather, double frequency_hz, double distance_m);
/// Returns the attenuation by fog over `distance_m`, dB. The value is exact.
double most_fog_db(const Weather& weather, double frequency_hz, double distance_m);

}  // namespace greatx::rf
