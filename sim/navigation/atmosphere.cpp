// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "sim/navigation/atmosphere.h"

#include <cmath>

#include <fmt/format.h>

#include "core/error.h"

namespace greatx::navigation {

namespace {

constexpr double air_gas_constant = 8314.32 / 28.9644;  // J/(kg K), R* / M0
constexpr double air_gravity = 9.80665, air_earth_radius_m = 6356766.0;
constexpr double lowest_m = -5000.0, highest_m = 32000.0;  // of geopotential height

/// A layer: from its base upwards, with a constant gradient of temperature.
struct Layer {
  double base_m, temperature_k, gradient_k_m;
};
constexpr Layer layers[] = {{0.0, 288.15, -6.5e-3}, {11000.0, 216.65, 0.0}, {20000.0, 216.65, 1e-3}};

/// Returns the ratio of the pressures at a geopotential height and at the base of its layer.
double ratio_in(const Layer& layer, double height_m) {
  const double rise_m = height_m - layer.base_m;
  if (layer.gradient_k_m == 0.0)
    return std::exp(-air_gravity * rise_m / (air_gas_constant * layer.temperature_k));
  return std::pow(1.0 + layer.gradient_k_m * rise_m / layer.temperature_k,
                  -air_gravity / (air_gas_constant * layer.gradient_k_m));
}

}  // namespace

double air_pressure(double height_m, double sea_level_pa) {
  const double geopotential_m = air_earth_radius_m * height_m / (air_earth_radius_m + height_m);
  if (!(geopotential_m >= lowest_m && geopotential_m <= highest_m))
    throw_user_error(
        "the standard atmosphere has pressures from {:g} m to {:g} m above the sea, not at {:g} m", lowest_m,
        highest_m, height_m);
  double pressure = sea_level_pa;
  for (size_t i = 0; i < std::size(layers); ++i) {
    const bool last = i + 1 == std::size(layers) || geopotential_m < layers[i + 1].base_m;
    pressure *= ratio_in(layers[i], last ? geopotential_m : layers[i + 1].base_m);
    if (last) break;
  }
  return pressure;
}

double pressure_height(double pressure_pa, double sea_level_pa) {
  double base_pa = sea_level_pa;
  for (size_t i = 0; i < std::size(layers); ++i) {
    const Layer& layer = layers[i];
    const bool last = i + 1 == std::size(layers);
    const double top_pa = last ? 0.0 : base_pa * ratio_in(layer, layers[i + 1].base_m);
    if (!last && pressure_pa < top_pa) {
      base_pa = top_pa;
      continue;
    }
    const double ratio = pressure_pa / base_pa;
    const double rise_m =
        layer.gradient_k_m == 0.0
            ? -std::log(ratio) * air_gas_constant * layer.temperature_k / air_gravity
            : layer.temperature_k / layer.gradient_k_m *
                  (std::pow(ratio, -air_gas_constant * layer.gradient_k_m / air_gravity) - 1.0);
    const double geopotential_m = layer.base_m + rise_m;
    return air_earth_radius_m * geopotential_m / (air_earth_radius_m - geopotential_m);
  }
  return 0.0;  // the last layer has returned
}

Barometer::Barometer(const BarometerErrors& errors, uint64_t seed, const std::string& name, uint32_t sequence,
                     double step_s)
    : errors_(errors),
      constant_(errors.bias_std *
                NormalStream(StreamKey(seed, fmt::format("{}/constant", name), sequence)).at(0)),
      white_(StreamKey(seed, fmt::format("{}/white", name), sequence)),
      drift_(StreamKey(seed, fmt::format("{}/drift", name), sequence), errors.drift_std, errors.drift_time_s,
             step_s) {}

Barometer::Sample Barometer::measure(double truth_pa, int64_t sample) {
  Sample out;
  out.bias_pa = constant_ + drift_.at(sample);
  out.measured_pa = truth_pa + out.bias_pa;
  if (errors_.noise_std > 0.0)
    out.measured_pa += errors_.noise_std * white_.at(static_cast<uint64_t>(sample));
  if (errors_.resolution > 0.0)
    out.measured_pa = errors_.resolution * std::round(out.measured_pa / errors_.resolution);
  return out;
}

}  // namespace greatx::navigation
