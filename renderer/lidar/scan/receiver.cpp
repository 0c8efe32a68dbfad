// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "renderer/lidar/scan/receiver.h"

#include <cmath>
#include <numbers>

#include "core/error.h"
#include "core/units.h"
#include "shaders/shared/random.h"

namespace greatx::render {

double air_transmittance(const Receiver& receiver, double range_m) {
  if (receiver.extinction_per_m == 0.0) return 1.0;  // as exp gives, which every echo of clear air would call
  return std::exp(-2.0 * receiver.extinction_per_m * range_m);
}

double received_power(const Receiver& receiver, double range_m, double intensity) {
  const double d = receiver.aperture_diameter_m;
  return intensity * d * d * receiver.system_efficiency / (4.0 * range_m * range_m) *
         air_transmittance(receiver, range_m);
}

Receiver::Detection rated(const Receiver& receiver, double range_m, double reflectance, double probability,
                          double threshold) {
  Receiver clear = receiver;
  clear.extinction_per_m = 0.0;
  const double ratio = threshold + normal_quantile(probability);
  GREATX_CHECK(ratio > 0.0, "a probability of {} with a threshold of {}", probability, threshold);
  return {received_power(clear, range_m, reflectance) / ratio, threshold};
}

double normal_cdf(double x) { return 0.5 * std::erfc(-x / std::numbers::sqrt2); }

double normal_quantile(double p) {
  GREATX_CHECK(p > 0.0 && p < 1.0, "quantile of {}", p);
  // The function bisects the distribution itself. It is called a few times a run, and it needs no table of
  // coefficients.
  double low = -40.0, high = 40.0;
  for (int i = 0; i < 200 && low < high; ++i) {
    const double middle = 0.5 * (low + high);
    if (middle == low || middle == high) break;
    (normal_cdf(middle) < p ? low : high) = middle;
  }
  return 0.5 * (low + high);
}

ShotNoise::ShotNoise(uint64_t seed, uint32_t stream, uint32_t sequence, int64_t tick)
    : tick_(static_cast<uint32_t>(tick), static_cast<uint32_t>(static_cast<uint64_t>(tick) >> 32)) {
  // Each sensor and sequence has a key of its own, so that the counter is left for ticks and shots.
  const shared::uvec4 key =
      shared::philox4x32(shared::uvec4(stream, sequence, 0x6c696472u, 0u),
                         shared::uvec2(static_cast<uint32_t>(seed), static_cast<uint32_t>(seed >> 32)));
  key_ = {key.x, key.y};
}

glm::uvec4 ShotNoise::bits(uint32_t shot, Purpose purpose, uint32_t index) const {
  GREATX_CHECK(index < (1u << 24), "draw {}", index);
  return shared::philox4x32({tick_.x, tick_.y, shot, static_cast<uint32_t>(purpose) << 24 | index}, key_);
}

double ShotNoise::uniform(uint32_t shot, Purpose purpose, uint32_t index) const {
  const glm::uvec4 words = bits(shot, purpose, index);
  return static_cast<double>((uint64_t{words.x} << 32 | words.y) >> 11) * 0x1p-53;
}

/// Draws a normal number by the method of Box and Muller.
double ShotNoise::normal(uint32_t shot, Purpose purpose, uint32_t index) const {
  const glm::uvec4 words = bits(shot, purpose, index);
  const auto unit = [](uint32_t high, uint32_t low) {
    return (static_cast<double>((uint64_t{high} << 32 | low) >> 12) + 0.5) * 0x1p-52;  // never 0
  };
  return std::sqrt(-2.0 * std::log(unit(words.x, words.y))) * std::cos(2.0 * pi * unit(words.z, words.w));
}

}  // namespace greatx::render
