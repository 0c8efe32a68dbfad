// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "rf/atmosphere/bounds.h"

#include <algorithm>

#include "rf/atmosphere/path_attenuation.h"

namespace greatx::rf {

double most_gas_db(const Weather& weather, double frequency_hz, double distance_m) {
  return path_attenuation(weather, frequency_hz, {.gas = true, .rain = false, .fog = false}).gas *
         distance_m * 1e-3;
}

double most_rain_db(const Weather& weather, double frequency_hz, double distance_m) {
  const PathAttenuation rain =
      path_attenuation(weather, frequency_hz, {.gas = false, .rain = true, .fog = false});
  return std::max(rain.rain_h, rain.rain_v) * distance_m * 1e-3;
}

double most_fog_db(const Weather& weather, double frequency_hz, double distance_m) {
  return path_attenuation(weather, frequency_hz, {.gas = false, .rain = false, .fog = true}).fog *
         distance_m * 1e-3;
}

}  // namespace greatx::rf
