// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>

#include <gtest/gtest.h>

#include "core/error.h"
#include "rf/channel/pair_amplitudes.h"
#include "rf/channel/statistics.h"
#include "tests/rf/channel_paths.h"

namespace greatx::rf {
namespace {

using testing::antenna;
using testing::direction_at;
using testing::plain_path;
using testing::random_paths;

TEST(LinkStatistics, TwoPaths) {
  // With powers p and q, the spread of a two-point distribution is sqrt(p q)/(p + q) times the distance of
  // the points.
  std::vector<Path> paths{plain_path(100e-9), plain_path(180e-9, 1.0, false)};
  paths[0].doppler_hz = 40.0;
  paths[1].doppler_hz = -60.0;
  const std::vector<double> powers{3.0, 1.0};
  const LinkStatistics link = link_statistics(paths, powers);
  EXPECT_EQ(link.paths, 2u);
  EXPECT_TRUE(link.line_of_sight);
  EXPECT_DOUBLE_EQ(link.path_gain, 4.0);
  EXPECT_DOUBLE_EQ(link.k_factor, 3.0);
  EXPECT_NEAR(link.mean_delay_s, 120e-9, 1e-21);
  EXPECT_NEAR(link.delay_spread_s, 80e-9 * std::sqrt(3.0) / 4.0, 1e-21);
  EXPECT_NEAR(link.mean_doppler_hz, 15.0, 1e-13);
  EXPECT_NEAR(link.doppler_spread_hz, 100.0 * std::sqrt(3.0) / 4.0, 1e-13);
  EXPECT_EQ(link.arrival_azimuth_spread, 0.0);
}

TEST(LinkStatistics, KFactorCountsTheLineOfSightAlone) {
  std::vector<Path> paths{plain_path(1e-7), plain_path(2e-7, 1.0, false), plain_path(3e-7, 1.0, false)};
  EXPECT_DOUBLE_EQ(link_statistics(paths, std::vector{8.0, 1.5, 0.5}).k_factor, 4.0);
  EXPECT_EQ(link_statistics(paths, std::vector{8.0, 0.0, 0.0}).k_factor,
            std::numeric_limits<double>::infinity());
  EXPECT_EQ(link_statistics(paths, std::vector{0.0, 1.5, 0.5}).k_factor, 0.0);
  EXPECT_TRUE(link_statistics(paths, std::vector{0.0, 1.5, 0.5}).line_of_sight);
  paths.erase(paths.begin());
  const LinkStatistics shadowed = link_statistics(paths, std::vector{1.5, 0.5});
  EXPECT_EQ(shadowed.k_factor, 0.0);
  EXPECT_FALSE(shadowed.line_of_sight);
}

/// Returns the spread of two equal powers at a distance of 2 `half`: sqrt(-2 ln cos(half)).
double two_angles(double half) { return std::sqrt(-2.0 * std::log(std::cos(half))); }

TEST(LinkStatistics, AngleSpreadsCrossTheSeam) {
  // The spread about pi, 0 or any other angle is the same, wherever the angle wraps around.
  for (const double centre : {0.0, 1.0, pi - 1e-9, pi, -pi, 5.0})
    for (const double half : {radians(1.0), radians(40.0), radians(85.0)}) {
      std::vector<Path> paths{plain_path(1e-7), plain_path(2e-7, 1.0, false)};
      paths[0].arrival = direction_at(0.5 * pi, centre - half);
      paths[1].arrival = direction_at(0.5 * pi, centre + half);
      paths[0].departure = direction_at(1.0 - 0.3, centre);
      paths[1].departure = direction_at(1.0 + 0.3, centre);
      const LinkStatistics link = link_statistics(paths, std::vector{2.0, 2.0});
      EXPECT_NEAR(link.arrival_azimuth_spread, two_angles(half), 1e-12) << centre << " " << half;
      EXPECT_NEAR(link.departure_zenith_spread, two_angles(0.3), 1e-12);
      EXPECT_NEAR(link.departure_azimuth_spread, 0.0, 1e-12);
      EXPECT_NEAR(link.arrival_zenith_spread, 0.0, 1e-12);
    }
}

TEST(LinkStatistics, SmallAngleSpreadIsTheRmsDeviation) {
  // The function -2 ln R becomes the variance without a loss of digits in R.
  std::vector<Path> paths{plain_path(1e-7), plain_path(2e-7, 1.0, false)};
  paths[0].arrival = direction_at(0.5 * pi, 0.0);
  paths[1].arrival = direction_at(0.5 * pi, 2e-9);
  EXPECT_NEAR(link_statistics(paths, std::vector{1.0, 1.0}).arrival_azimuth_spread, 1e-9, 1e-17);
}

TEST(LinkStatistics, DirectionsThatCancelHaveNoBound) {
  std::vector<Path> paths(4, plain_path(1e-7));
  for (int i = 0; i < 4; ++i) paths[i].arrival = direction_at(0.5 * pi, 0.5 * pi * i);
  EXPECT_GT(link_statistics(paths, std::vector(4, 1.0)).arrival_azimuth_spread, 8.0);
}

TEST(LinkStatistics, ASinglePathHasNoSpreads) {
  for (Path path : random_paths(20, 1e-5, 7)) {
    const LinkStatistics link = link_statistics(std::span(&path, 1), std::vector{1e-13});
    EXPECT_EQ(link.mean_delay_s, path.delay_s);
    EXPECT_EQ(link.mean_doppler_hz, path.doppler_hz);
    for (const double spread :
         {link.delay_spread_s, link.doppler_spread_hz, link.departure_azimuth_spread,
          link.departure_zenith_spread, link.arrival_azimuth_spread, link.arrival_zenith_spread})
      EXPECT_EQ(spread, 0.0);
  }
}

TEST(LinkStatistics, WithoutPowerNothingIsDefined) {
  const std::vector<Path> dark{plain_path(1e-7)};
  for (const LinkStatistics& link : {link_statistics({}, {}), link_statistics(dark, std::vector{0.0})}) {
    EXPECT_EQ(link.path_gain, 0.0);
    for (const double value :
         {link.mean_delay_s, link.delay_spread_s, link.k_factor, link.departure_azimuth_spread,
          link.departure_zenith_spread, link.arrival_azimuth_spread, link.arrival_zenith_spread,
          link.mean_doppler_hz, link.doppler_spread_hz})
      EXPECT_TRUE(std::isnan(value));
  }
  EXPECT_EQ(link_statistics({}, {}).paths, 0u);
  EXPECT_FALSE(link_statistics({}, {}).line_of_sight);
  EXPECT_TRUE(link_statistics(dark, std::vector{0.0}).line_of_sight);
}

TEST(LinkStatistics, APathWithoutPowerWeighsNothing) {
  auto paths = random_paths(10, 1e-6, 8);
  std::vector<double> powers = path_powers(paths, antenna(), antenna(), 28e9);
  const LinkStatistics before = link_statistics(paths, powers);
  paths.insert(paths.begin(), plain_path(0.0));
  powers.insert(powers.begin(), 0.0);
  LinkStatistics after = link_statistics(paths, powers);
  EXPECT_EQ(after.paths, 11u);
  EXPECT_EQ(after.delay_spread_s, before.delay_spread_s);
  EXPECT_EQ(after.arrival_azimuth_spread, before.arrival_azimuth_spread);
  EXPECT_EQ(after.path_gain, before.path_gain);
}

TEST(LinkStatistics, AnyOrderOfPathsGivesTheSameBits) {
  auto paths = random_paths(5000, 10e-6, 9);
  for (size_t i = 0; i < 100; ++i) paths[i] = paths[i + 100];                    // duplicates
  for (size_t i = 200; i < 300; ++i) paths[i].delay_s = paths[i + 100].delay_s;  // ties
  const auto tally = [&] {
    return link_statistics(paths, path_powers(paths, antenna(), antenna(Pattern::half_wave_dipole), 28e9));
  };
  const LinkStatistics first = tally();
  testing::shuffle(paths, 9);
  const LinkStatistics second = tally();
  for (const auto value :
       {&LinkStatistics::path_gain, &LinkStatistics::mean_delay_s, &LinkStatistics::delay_spread_s,
        &LinkStatistics::k_factor, &LinkStatistics::departure_azimuth_spread,
        &LinkStatistics::departure_zenith_spread, &LinkStatistics::arrival_azimuth_spread,
        &LinkStatistics::arrival_zenith_spread, &LinkStatistics::mean_doppler_hz,
        &LinkStatistics::doppler_spread_hz})
    EXPECT_EQ(first.*value, second.*value);
}

TEST(PathPowers, AreTheMeanOverAllPairsOfPorts) {
  const auto paths = random_paths(12, 1e-6, 10);
  ArrayPose tx = antenna(Pattern::half_wave_dipole, Polarization::slant);
  tx.array.rows = 2;
  tx.array.columns = 3;
  tx.array.row_spacing_m = 0.05;
  tx.array.column_spacing_m = 0.04;
  tx.orientation = orientation_from_yaw_pitch_roll(0.7, 0.2, -0.4);
  ArrayPose rx = antenna(Pattern::isotropic, Polarization::vh);
  rx.array.columns = 2;
  rx.array.column_spacing_m = 0.043;
  const auto powers = path_powers(paths, tx, rx, 3.5e9);
  const ImpulseResponse impulse = impulse_response(paths, tx, rx, 3.5e9);
  const size_t pairs = impulse.amplitude.size() / paths.size();
  ASSERT_EQ(pairs, 12u * 4);
  for (size_t i = 0; i < paths.size(); ++i) {
    double sum = 0.0;
    for (size_t pair = 0; pair < pairs; ++pair)
      sum += std::norm(std::complex<double>(impulse.amplitude[i * pairs + pair]));
    EXPECT_NEAR(powers[i] / (sum / static_cast<double>(pairs)), 1.0,
                1e-6);  // the impulse response is complex64
  }
}

TEST(PathPowers, LineOfSightIsFriis) {
  const double distance = 123.0, carrier = 3.5e9;
  const Path path = plain_path(distance / speed_of_light, 1.0 / distance);
  const double friis = std::pow(speed_of_light / carrier / (4 * pi * distance), 2);
  const auto gain = [&](const ArrayPose& tx, const ArrayPose& rx) {
    return path_powers(std::span(&path, 1), tx, rx, carrier)[0] / friis;
  };
  EXPECT_NEAR(gain(antenna(), antenna()), 1.0, 1e-14);
  const ArrayPose dipole = antenna(Pattern::half_wave_dipole);
  EXPECT_NEAR(gain(dipole, dipole), 1.6409223770 * 1.6409223770, 1e-12);
  // Both ends have both polarizations: half of the pairs are crossed.
  EXPECT_NEAR(
      gain(antenna(Pattern::isotropic, Polarization::vh), antenna(Pattern::isotropic, Polarization::vh)), 0.5,
      1e-14);
}

TEST(LinkStatistics, RefusesPowersOfOtherPaths) {
  const std::vector<Path> paths{plain_path(1e-7)};
  EXPECT_THROW(link_statistics(paths, {}), ContractError);
  EXPECT_THROW(link_statistics(paths, std::vector{-1.0}), ContractError);
  EXPECT_THROW(link_statistics(paths, std::vector{std::nan("")}), ContractError);
}

}  // namespace
}  // namespace greatx::rf
