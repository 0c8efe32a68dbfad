// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "renderer/daylight/haze.h"

#include <cmath>
#include <limits>
#include <numbers>

namespace greatx::render {

double fog_extinction(double liquid_water_g_m3) {
  return liquid_water_g_m3 > 0.0 ? 144.7e-3 * std::pow(liquid_water_g_m3, 0.88) : 0.0;
}

double rain_extinction(double rain_mm_h) {
  constexpr double db_per_km_to_per_m = std::numbers::ln10 / 10.0 * 1e-3;
  return rain_mm_h > 0.0 ? 1.076 * std::pow(rain_mm_h, 0.67) * db_per_km_to_per_m : 0.0;
}

double visibility_m(double extinction_per_m) {
  return extinction_per_m > 0.0 ? std::log(50.0) / extinction_per_m : std::numeric_limits<double>::infinity();
}

LayerLight through_layer(double direct_lux, double sine, double sky_lux, double depth, double ground_albedo) {
  const double level = sine > 0.0 ? direct_lux * sine : 0.0;
  const double passed = 1.0 / (1.0 + 0.5 * (1.0 - haze_asymmetry) * depth);
  const double total = (level + sky_lux) * passed / (1.0 - ground_albedo * (1.0 - passed));
  const double straight = sine > 0.0 ? std::exp(-depth / sine) : 0.0;
  return {sine > 0.0 ? direct_lux * straight : 0.0, total - level * straight};
}

}  // namespace greatx::render
