// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Tests the sensor noise and the tone curve as functions. Tests of significance reject at a level of 1e-4
// each. Their draws are the same in every run, so that a test that passes always passes.
#include "shaders/shared/film.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include <glm/gtc/packing.hpp>
#include <gmock/gmock.h>

#include "core/units.h"
#include "shaders/shared/develop.h"

namespace greatx::shared {
namespace {

/// The absolute value of a standard normal variable exceeds this with a probability of 1e-4.
constexpr double rare = 3.891;

double normal_cdf(double z) { return 0.5 * std::erfc(-z / std::sqrt(2.0)); }

/// Returns the value that chi-squared of `degrees` degrees of freedom exceeds with a probability of 1e-4
/// (Wilson and Hilferty 1931).
double rare_chi_squared(double degrees) {
  const double a = 2.0 / (9.0 * degrees);
  return degrees * std::pow(1.0 - a + 3.719 * std::sqrt(a), 3.0);
}

SensorConstants sensor(float read_noise, float full_well = 10000.0f, uint bits = 12, uint tick = 7) {
  return {full_well, read_noise, float((1u << bits) - 1u), tick, uvec2(0x1234u, 0x5678u)};
}

struct Moments {
  double mean = 0.0, variance = 0.0, fourth = 0.0;
};
Moments moments(const std::vector<double>& values) {
  Moments m;
  for (const double v : values) m.mean += v;
  m.mean /= double(values.size());
  for (const double v : values) {
    const double d = v - m.mean;
    m.variance += d * d;
    m.fourth += d * d * d * d;
  }
  m.variance /= double(values.size());
  m.fourth /= double(values.size());
  return m;
}

std::vector<double> electrons(float mean, float read_noise, uint count, uint tick = 1) {
  std::vector<double> values;
  for (uint i = 0; i < count; ++i)
    values.push_back(noisy_electrons(mean, read_noise, unit_float(random_bits(1u, 2u, tick, i, 0u).x)));
  return values;
}

TEST(Film, BytesAreWithinAHundredthOfTheExactCurve) {
  double worst = 0.0;
  uint last = 0;
  for (uint32_t half = 0; half <= 0x3c00u; ++half) {  // every half-precision number from 0 to 1
    const float c = glm::unpackHalf1x16(uint16_t(half));
    const double exact = c <= 0.0031308f ? 12.92 * c : 1.055 * std::pow(double(c), 1.0 / 2.4) - 0.055;
    const uint byte = srgb_byte(c);
    worst = std::max(worst, std::abs(byte - 255.0 * exact));
    EXPECT_GE(byte, last) << c;
    last = byte;
  }
  EXPECT_LE(worst, 0.51);
  EXPECT_EQ(srgb_byte(0.0f), 0u);
  EXPECT_EQ(srgb_byte(1.0f), 255u);
}

TEST(Film, ToneCurveIsTheFormulaAndStaysWithinOne) {
  for (const float x : {0.0f, 1e-6f, 0.01f, 0.18f, 0.5f, 1.0f, 4.0f, 60.0f, 65504.0f}) {
    for (const vec3 tint : {vec3(1.0f), vec3(1.0f, 0.5f, 0.0f), vec3(0.1f, 0.9f, 1.0f)}) {
      const vec3 got = tone_map(x * tint);
      const double peak = x, new_peak = 1.0 - std::exp(-2.2 * peak);
      const double g = std::min(1.0 - 1.0 / (0.15 * std::max(peak - new_peak, 0.0) + 1.0), 0.25);
      for (int c = 0; c < 3; ++c) {
        const double ratio = peak > 0.0 ? new_peak / peak : 2.2;
        const double expected = x * tint[c] * ratio * (1.0 - g) + new_peak * g;
        EXPECT_NEAR(got[c], expected, 2e-6) << x;
        EXPECT_GE(got[c], -2e-7f);
        EXPECT_LE(got[c], 1.0f + 2e-7f);
      }
    }
  }
}

TEST(Film, NormalQuantileInvertsTheNormalLaw) {
  for (double u = 0.5 / 16777216.0; u < 1.0; u += 1.0 / 4099.0)
    EXPECT_NEAR(normal_cdf(normal_quantile(float(u))) / double(float(u)), 1.0, 3e-5) << u;
  EXPECT_NEAR(normal_quantile(0.5f), 0.0f, 1e-6f);
}

TEST(Film, PhotonTransfer) {
  // Checks the mean and the variance of electrons at several levels of grey. The mean is that of the light,
  // the variance is the mean plus the variance of the read noise.
  constexpr uint count = 60000;
  for (const float read_noise : {0.0f, 2.5f}) {
    for (const float mean : {0.0f, 0.3f, 1.0f, 5.0f, 15.9f, 16.0f, 40.0f, 500.0f, 9000.0f}) {
      const double variance = double(mean) + double(read_noise) * read_noise;
      const Moments m = moments(electrons(mean, read_noise, count));
      if (variance == 0.0) {
        EXPECT_EQ(m.mean, 0.0);
        EXPECT_EQ(m.variance, 0.0);
        continue;
      }
      EXPECT_LT(std::abs(m.mean - mean), rare * std::sqrt(variance / count)) << mean << " " << read_noise;
      // The fourth central moment of Poisson plus normal is 3 v^2 + mean.
      const double spread = std::sqrt((3.0 * variance * variance + mean - variance * variance) / count);
      EXPECT_LT(std::abs(m.variance - variance), rare * spread) << mean << " " << read_noise;
    }
  }
}

TEST(Film, VarianceOverMeanIsTheGain) {
  // In digital numbers, the slope of the photon transfer curve is 1 / gain. Its offset is read noise and
  // quantisation.
  const SensorConstants s = sensor(4.0f, 20000.0f, 10);
  const double per_electron = double(s.levels) / s.full_well;
  constexpr uint count = 40000;
  for (const float light : {0.02f, 0.1f, 0.3f, 0.7f}) {
    std::vector<double> numbers;
    for (uint i = 0; i < count; ++i) numbers.push_back(double(sensed_color(vec3(light), s, i).x) * s.levels);
    const Moments m = moments(numbers);
    const double mean = light * s.levels;
    const double variance = per_electron * mean + std::pow(4.0 * per_electron, 2.0) + 1.0 / 12.0;
    EXPECT_LT(std::abs(m.mean - mean), rare * std::sqrt(variance / count) + 1e-3) << light;
    EXPECT_LT(std::abs(m.variance / variance - 1.0), rare * std::sqrt(2.0 / count) + 2e-3) << light;
  }
}

TEST(Film, FewElectronsFollowPoissonsLaw) {
  constexpr uint count = 100000;
  for (const float mean : {0.05f, 0.7f, 3.0f, 15.5f}) {
    std::array<uint, 65> seen{};
    for (const double e : electrons(mean, 0.0f, count)) {
      ASSERT_EQ(e, std::floor(e));
      ++seen[std::min<size_t>(size_t(e), 64)];
    }
    // Chi-squared over counts with an expectation of at least ten; the tail is one count.
    double chi = 0.0, left = 1.0, probability = std::exp(-double(mean));
    uint used = 0, left_seen = count;
    for (uint k = 0; k < 64 && left * count > 20.0; ++k) {
      if (probability * count >= 10.0) {
        chi += std::pow(seen[k] - probability * count, 2.0) / (probability * count);
        left -= probability;
        left_seen -= seen[k];
        ++used;
      }
      probability *= mean / (k + 1.0);
    }
    if (left * count > 1.0) chi += std::pow(left_seen - left * count, 2.0) / (left * count);
    EXPECT_LT(chi, rare_chi_squared(used)) << mean;
  }
}

TEST(Film, ManyElectronsAreCloseToPoissonPlusReading) {
  // Compares the distribution function with a sum of normal laws with Poisson weights. The difference is
  // largest where the model changes its law.
  for (const auto& [mean, bound] : {std::pair{16.0, 2e-3}, {100.0, 4e-4}, {1000.0, 1e-4}}) {
    const double read_noise = 2.5;
    double worst = 0.0;
    for (double u = 0.0005; u < 1.0; u += 0.001) {
      const double e = noisy_electrons(float(mean), float(read_noise), float(u));
      double below = 0.0;
      for (int k = 0; k < 2000; ++k)
        below +=
            std::exp(k * std::log(mean) - mean - std::lgamma(k + 1.0)) * normal_cdf((e - k) / read_noise);
      worst = std::max(worst, std::abs(below - u));
    }
    EXPECT_LT(worst, bound) << mean;
  }
}

TEST(Film, FewElectronsWithReadingAreTheExactLaw) {
  const double mean = 3.0, read_noise = 1.5;
  std::vector<double> values = electrons(float(mean), float(read_noise), 50000);
  std::ranges::sort(values);
  double distance = 0.0;
  for (size_t i = 0; i < values.size(); i += 5) {
    double below = 0.0;
    for (int k = 0; k < 60; ++k)
      below += std::exp(k * std::log(mean) - mean - std::lgamma(k + 1.0)) *
               normal_cdf((values[i] - k) / read_noise);
    distance = std::max(distance, std::abs(below - (double(i) + 0.5) / double(values.size())));
  }
  // The limit of the test of Kolmogorov and Smirnov at 1e-4 is 2.225 / sqrt(n).
  EXPECT_LT(distance, 2.225 / std::sqrt(50000.0));
}

TEST(Film, QuantisationErrorIsUniform) {
  // With 4 bits for 1000 electrons, a step is 67 electrons and the noise is several steps wide.
  SensorConstants s = sensor(200.0f, 1000.0f, 4);
  std::array<double, 10> bins{};
  constexpr uint count = 50000;
  uint used = 0;
  for (uint i = 0; i < count; ++i) {
    const uvec4 bits = random_bits(s.key.x, s.key.y, s.tick, i, 0u);
    const double exact =
        noisy_electrons(500.0f, s.read_noise, unit_float(bits.x)) * (double(s.levels) / s.full_well);
    if (exact < 0.0 || exact > s.levels) continue;
    const double number = std::round(double(sensed_color(vec3(0.5f), s, i).x) * s.levels);
    const double error = number - exact;
    EXPECT_LE(std::abs(error), 0.5 + 1e-4);
    ++bins[std::clamp(size_t((error + 0.5) * 10.0), size_t{0}, size_t{9})];
    ++used;
  }
  double chi = 0.0;
  for (const double n : bins) chi += std::pow(n - used / 10.0, 2.0) / (used / 10.0);
  EXPECT_LT(chi, rare_chi_squared(9.0));
}

TEST(Film, NoiseIsIndependentOfNeighboursChannelsTicksAndSensors) {
  constexpr uint count = 40000;
  const SensorConstants now = sensor(2.5f), next = sensor(2.5f, 10000.0f, 12, 8);
  SensorConstants other = now;
  other.key = uvec2(0x1234u, 0x5679u);
  const auto pixel = [](const SensorConstants& s, uint i) { return sensed_color(vec3(0.3f), s, i); };
  const Moments m = [&] {
    std::vector<double> values;
    for (uint i = 0; i < count; ++i) values.push_back(pixel(now, i).x);
    return moments(values);
  }();
  const auto correlation = [&](auto&& pair) {
    double sum = 0.0;
    for (uint i = 0; i < count; ++i) {
      const auto [a, b] = pair(i);
      sum += (a - m.mean) * (b - m.mean);
    }
    return sum / (count * m.variance);
  };
  const double limit = rare / std::sqrt(double(count));
  using Pair = std::pair<double, double>;
  EXPECT_LT(std::abs(correlation([&](uint i) { return Pair(pixel(now, i).x, pixel(now, i + 1).x); })), limit);
  EXPECT_LT(std::abs(correlation([&](uint i) { return Pair(pixel(now, i).x, pixel(now, i + 640).x); })),
            limit);
  EXPECT_LT(std::abs(correlation([&](uint i) { return Pair(pixel(now, i).x, pixel(now, i).y); })), limit);
  EXPECT_LT(std::abs(correlation([&](uint i) { return Pair(pixel(now, i).y, pixel(now, i).z); })), limit);
  EXPECT_LT(std::abs(correlation([&](uint i) { return Pair(pixel(now, i).x, pixel(next, i).x); })), limit);
  EXPECT_LT(std::abs(correlation([&](uint i) { return Pair(pixel(now, i).x, pixel(other, i).x); })), limit);
}

TEST(Film, TheConverterEndsAtTheFullWell) {
  const SensorConstants s = sensor(2.5f);
  for (uint i = 0; i < 1000; ++i) {
    EXPECT_EQ(sensed_color(vec3(1.2f), s, i), vec3(1.0f));
    EXPECT_EQ(sensed_color(vec3(65504.0f), s, i), vec3(1.0f));
    const vec3 dark = sensed_color(vec3(0.0f), s, i);
    EXPECT_GE(std::min({dark.x, dark.y, dark.z}), 0.0f);
    EXPECT_LE(std::max({dark.x, dark.y, dark.z}), 8.0f / 4095.0f);
  }
}

}  // namespace
}  // namespace greatx::shared
