// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "rf/atmosphere/bounds.h"

#include <algorithm>
#include <cmath>

#include "core/units.h"

namespace greatx::rf {
namespace {

RainAttenuation rain_at(const PathAttenuation& air, double cos2_elevation) {
  return air.rain_mm_h > 0.0 ? rain_db_per_km(air.rain, air.rain_mm_h, cos2_elevation) : RainAttenuation{};
}

}  // namespace

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

double most_air_change_db(const Weather& weather, const WeatherEffects& effects, const Band& band,
                          double distance_m) {
  constexpr int elevations = 12;
  constexpr double sample_m = 1e3;
  const PathAttenuation carrier = path_attenuation(weather, band.carrier_hz, effects);
  const uint32_t steps = steps_over(band.width_hz(), 50e6, 4, 400);
  double most_db = 0.0;  // over sample_m
  for (uint32_t i = 0; i <= steps; ++i) {
    const PathAttenuation air = path_attenuation(weather, band.sample_hz(i, steps), effects);
    const double isotropic = air.isotropic() - carrier.isotropic();
    for (int e = 0; e <= (carrier.rain_mm_h > 0.0 ? elevations : 0); ++e) {
      const double level = std::cos(0.5 * pi * e / elevations);
      const RainAttenuation there = rain_at(air, level * level), here = rain_at(carrier, level * level);
      most_db =
          std::max({most_db, std::abs(isotropic + there.h - here.h), std::abs(isotropic + there.v - here.v)});
    }
  }
  return most_db * distance_m / sample_m;
}

}  // namespace greatx::rf
