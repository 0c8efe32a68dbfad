// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// The processes of noise, compared with the closed forms of their variances, correlations and Allan
// deviations. Numbers are drawn by counter, so that every run sees the same ones. Tolerances are three to
// four standard deviations of an estimate from so many samples.
#include <cmath>
#include <set>
#include <vector>

#include <gtest/gtest.h>

#include "core/units.h"
#include "sim/navigation/presets.h"
#include "sim/navigation/random_process.h"
#include "sim/navigation/triad.h"
#include "tests/sim/navigation/allan.h"

namespace greatx::navigation {
namespace {

StreamKey key_of(const char* name) { return {11, name, 0}; }

TEST(NormalStream, HasTheMomentsOfANormalDistribution) {
  const NormalStream stream(key_of("moments"));
  constexpr size_t count = 400'000;
  double sums[5] = {}, lagged = 0.0, last = 0.0;
  size_t within = 0;
  for (size_t i = 0; i < count; ++i) {
    const double x = stream.at(i);
    double power = 1.0;
    for (double& sum : sums) sum += power, power *= x;
    lagged += x * last;
    last = x;
    within += std::abs(x) < 1.0;
  }
  EXPECT_NEAR(sums[1] / count, 0.0, 0.006);
  EXPECT_NEAR(sums[2] / count, 1.0, 0.009);
  EXPECT_NEAR(sums[3] / count, 0.0, 0.02);
  EXPECT_NEAR(sums[4] / count, 3.0, 0.06);
  EXPECT_NEAR(lagged / count, 0.0, 0.006);
  EXPECT_NEAR(static_cast<double>(within) / count, 0.682689, 0.003);
}

TEST(NormalStream, DependsOnSeedNameAndSequenceAlone) {
  const double value = NormalStream({1, "a", 0}).at(7);
  EXPECT_EQ(value, NormalStream({1, "a", 0}).at(7));
  EXPECT_NE(value, NormalStream({2, "a", 0}).at(7));
  EXPECT_NE(value, NormalStream({1, "b", 0}).at(7));
  EXPECT_NE(value, NormalStream({1, "a", 1}).at(7));
  EXPECT_NE(value, NormalStream({1, "a", 0}).at(8));
  EXPECT_NE(NormalStream({1, "a", 0}).at(0), NormalStream({1, "a", 0}).at(1ull << 33));
}

TEST(GaussMarkov, HasItsVarianceAndCorrelation) {
  constexpr double sigma = 2.0, time_s = 5.0, step_s = 0.5;
  constexpr int64_t count = 400'000;
  GaussMarkov process(key_of("correlation"), sigma, time_s, step_s);
  std::vector<double> x;
  for (int64_t i = 0; i < count; ++i) x.push_back(process.at(i));
  for (const size_t lag : {0u, 1u, 10u, 30u}) {
    double product = 0.0;
    for (size_t i = lag; i < x.size(); ++i) product += x[i] * x[i - lag];
    const double expected = sigma * sigma * std::exp(-static_cast<double>(lag) * step_s / time_s);
    // The variance of the estimate is about 2 sigma^4 T / duration.
    const double deviation = sigma * sigma * std::sqrt(2.0 * time_s / (count * step_s));
    EXPECT_NEAR(product / static_cast<double>(x.size() - lag), expected, 4.0 * deviation) << lag;
  }
}

TEST(GaussMarkov, IsTheSameWhereverARunBegins) {
  GaussMarkov whole(key_of("resume"), 1.0, 3.0, 0.1), later(key_of("resume"), 1.0, 3.0, 0.1);
  RandomWalk walk(key_of("walk"), 1.0, 0.1), later_walk(key_of("walk"), 1.0, 0.1);
  std::vector<double> values, steps;
  for (int64_t i = 0; i < 200; ++i) values.push_back(whole.at(i)), steps.push_back(walk.at(i));
  EXPECT_EQ(later.at(150), values[150]);
  EXPECT_EQ(later.at(199), values[199]);
  EXPECT_EQ(later.at(3), values[3]);  // backwards, too
  EXPECT_EQ(later_walk.at(150), steps[150]);
  EXPECT_EQ(later_walk.at(150), steps[150]);
  EXPECT_EQ(later_walk.at(2), steps[2]);
  EXPECT_EQ(steps[0], 0.0);
}

/// Measures nothing but errors: `count` samples of the x axis at rest.
std::vector<double> at_rest(const TriadErrors& errors, double step_s, int64_t count, double truth = 0.0) {
  Triad triad(errors, 3, "imu/gyroscope", 0, step_s);
  std::vector<double> samples;
  for (int64_t i = 0; i < count; ++i) samples.push_back(triad.measure(dvec3(truth), i).measured.x);
  return samples;
}

TEST(Triad, WhiteNoiseHasTheAllanDeviationOfItsDensity) {
  constexpr double density = 2.4e-4, step_s = 0.005;
  const std::vector<double> x = at_rest({.noise_density = density}, step_s, 400'000);
  for (const size_t count : {1u, 10u, 100u, 1000u}) {
    const double tau_s = static_cast<double>(count) * step_s, expected = density / std::sqrt(tau_s);
    const double relative = 1.2 / std::sqrt(static_cast<double>(x.size()) / static_cast<double>(count));
    EXPECT_NEAR(test::allan_deviation(x, count) / expected, 1.0, 3.0 * relative) << tau_s;
  }
}

TEST(Triad, TheBiasWalkHasTheAllanDeviationOfARateRandomWalk) {
  constexpr double density = 3e-3, step_s = 0.005;
  const std::vector<double> x = at_rest({.bias_walk = density}, step_s, 400'000);
  for (const size_t count : {100u, 1000u, 4000u}) {
    const double tau_s = static_cast<double>(count) * step_s, expected = density * std::sqrt(tau_s / 3.0);
    const double relative = 1.2 / std::sqrt(static_cast<double>(x.size()) / static_cast<double>(count));
    EXPECT_NEAR(test::allan_deviation(x, count) / expected, 1.0, 3.0 * relative + 0.01) << tau_s;
  }
}

TEST(Triad, TheBiasInstabilityIsTheGreatestAllanDeviationOfItsProcess) {
  constexpr double instability = 1e-5, time_s = 10.0, step_s = 0.05;
  const std::vector<double> x =
      at_rest({.bias_instability = instability, .bias_time_s = time_s}, step_s, 400'000);
  const double sigma = instability / most_gauss_markov_allan;
  for (const double tau_s : {2.0, 5.0, 18.93, 50.0}) {
    const auto count = static_cast<size_t>(std::lround(tau_s / step_s));
    const double expected = test::gauss_markov_allan(sigma, time_s, static_cast<double>(count) * step_s);
    const double relative = 1.2 / std::sqrt(static_cast<double>(x.size()) / static_cast<double>(count));
    EXPECT_NEAR(test::allan_deviation(x, count) / expected, 1.0, 3.0 * relative) << tau_s;
  }
  // The constant is the maximum of the closed form.
  double most = 0.0, at = 0.0;
  for (double r = 0.5; r < 5.0; r += 1e-3)
    if (const double a = test::gauss_markov_allan(1.0, 1.0, r); a > most) most = a, at = r;
  EXPECT_NEAR(most, most_gauss_markov_allan, 1e-5);
  EXPECT_NEAR(at, 1.893, 2e-3);
}

TEST(Triad, RoundingHasTheAllanDeviationOfQuantizationAfterItsNoise) {
  // The rounding error of a signal that covers many quanta is uniform and white: q / sqrt(12) of each sample.
  constexpr double quantum = 1e-3, step_s = 0.01;
  constexpr double density = 20.0 * quantum * 0.1;  // sigma is 20 quanta
  const std::vector<double> smooth = at_rest({.noise_density = density}, step_s, 200'000);
  const std::vector<double> rounded =
      at_rest({.noise_density = density, .resolution = quantum}, step_s, 200'000);
  std::vector<double> error;
  for (size_t i = 0; i < smooth.size(); ++i) error.push_back(rounded[i] - smooth[i]);
  for (const double e : error) ASSERT_LE(std::abs(e), 0.5 * quantum * (1.0 + 1e-9));
  for (const size_t count : {1u, 10u, 100u})
    EXPECT_NEAR(test::allan_deviation(error, count) * std::sqrt(12.0 * static_cast<double>(count)) / quantum,
                1.0, 0.004 + 0.01 * std::sqrt(static_cast<double>(count)))
        << count;
}

TEST(Triad, SaturatesAtItsRangeAndDeliversMultiplesOfItsResolution) {
  const TriadErrors errors{.noise_density = 0.1, .resolution = 0.25, .range = 4.0};
  for (const double x : at_rest(errors, 0.01, 1000, 100.0)) ASSERT_EQ(x, 4.0);
  for (const double x : at_rest(errors, 0.01, 1000, -100.0)) ASSERT_EQ(x, -4.0);
  std::set<double> values;
  for (const double x : at_rest(errors, 0.01, 1000, 1.0)) {
    ASSERT_EQ(std::remainder(x, 0.25), 0.0);
    values.insert(x);
  }
  EXPECT_GT(values.size(), 5u);
}

TEST(Triad, DrawsConstantsOnceASequenceWithTheirDeviations) {
  const TriadErrors errors{.bias_std = 2.0, .scale_std = 0.01, .misalignment_std = 0.003};
  double bias = 0.0, scale = 0.0, misalignment = 0.0;
  constexpr uint32_t sequences = 3000;
  for (uint32_t sequence = 0; sequence < sequences; ++sequence) {
    Triad triad(errors, 5, "imu", sequence, 0.01);
    const TriadSample first = triad.measure(dvec3(0.0), 0), later = triad.measure(dvec3(0.0), 1000);
    ASSERT_EQ(first.measured, later.measured);
    ASSERT_EQ(first.measured, first.bias);
    // A column of I + M is what a unit along an axis adds.
    const dvec3 column = triad.measure(dvec3(0.0, 1.0, 0.0), 0).measured - first.bias;
    for (int i = 0; i < 3; ++i) ASSERT_NEAR(column[i], triad.scale()[1][i], 1e-12);
    bias += glm::dot(first.bias, first.bias) / 3.0;
    for (int c = 0; c < 3; ++c)
      for (int r = 0; r < 3; ++r) {
        const double m = triad.scale()[c][r] - (c == r ? 1.0 : 0.0);
        (c == r ? scale : misalignment) += m * m / (c == r ? 3.0 : 6.0);
      }
  }
  EXPECT_NEAR(std::sqrt(bias / sequences), 2.0, 0.06);
  EXPECT_NEAR(std::sqrt(scale / sequences), 0.01, 3e-4);
  EXPECT_NEAR(std::sqrt(misalignment / sequences), 0.003, 7e-5);
}

TEST(Triad, MeasuresTheTruthWithoutErrors) {
  Triad triad({}, 1, "ideal", 0, 0.01);
  const TriadSample sample = triad.measure({1.25, -2.5, 9.80665}, 123456789);
  EXPECT_EQ(sample.measured, dvec3(1.25, -2.5, 9.80665));
  EXPECT_EQ(sample.bias, dvec3(0.0));
}

TEST(ImuPresets, AreSensorsInTheOrderOfTheirGrades) {
  std::set<std::string_view> names;
  for (const ImuPreset& preset : imu_presets()) names.insert(preset.name);
  EXPECT_EQ(names, (std::set<std::string_view>{"ideal", "bmi088", "adis16448", "adis16495"}));
  EXPECT_EQ(imu_presets()[0].accelerometer, TriadErrors{});
  const auto of = [](std::string_view name) {
    for (const ImuPreset& preset : imu_presets())
      if (preset.name == name) return preset;
    return ImuPreset{};
  };
  // 0.014 and 0.0015 degrees/s/sqrt(Hz); 175 ug and 13.6 ug per sqrt(Hz).
  EXPECT_NEAR(degrees(of("bmi088").gyroscope.noise_density), 0.014, 1e-12);
  EXPECT_NEAR(degrees(of("adis16495").gyroscope.noise_density), 0.0015, 1e-12);
  EXPECT_NEAR(of("adis16495").accelerometer.noise_density / 9.80665 * 1e6, 13.6, 0.05);
  EXPECT_EQ(of("adis16448").gyroscope.noise_density, 1.6968e-4);
}

}  // namespace
}  // namespace greatx::navigation
