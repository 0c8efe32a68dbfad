// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include <cmath>
#include <limits>

#include <gtest/gtest.h>

#include "core/error.h"
#include "rf/channel/coherence.h"
#include "rf/config/subcarriers.h"
#include "tests/rf/channel_paths.h"

namespace greatx::rf {
namespace {

using testing::plain_path;
using testing::random_paths;

constexpr double infinity = std::numeric_limits<double>::infinity();

TEST(Coherence, ALevelBelowRoundingEndsAtTheNull) {
  const std::vector<Path> paths{plain_path(1e-6), plain_path(1e-6 + 250e-9, 1.0, false)};
  const std::vector<double> powers{1e-10, 1e-10};
  EXPECT_NEAR(coherence_bandwidth_hz(paths, powers, 1e-12) * 250e-9, 0.5, 1e-6);
}

TEST(Coherence, TwoPaths) {
  // |p + q e^{j x}|^2 = p^2 + q^2 + 2 p q cos x.
  const double apart = 250e-9;
  std::vector<Path> paths{plain_path(1e-6), plain_path(1e-6 + apart, 1.0, false)};
  paths[0].doppler_hz = 30.0;
  paths[1].doppler_hz = -50.0;
  for (const auto& [p, q] : {std::pair{0.5, 0.5}, {0.7, 0.3}, {0.26, 0.74}})
    for (const double level : {0.5, 0.9}) {
      const double angle = std::acos((level * level - p * p - q * q) / (2 * p * q));
      const std::vector<double> powers{3e-10 * p, 3e-10 * q};
      EXPECT_NEAR(coherence_bandwidth_hz(paths, powers, level) * 2 * pi * apart, angle, 1e-7);
      EXPECT_NEAR(coherence_time_s(paths, powers, level) * 2 * pi * 80.0, angle, 1e-7);
    }
  // A path with three quarters of the power keeps the correlation above one half.
  EXPECT_EQ(coherence_bandwidth_hz(paths, std::vector{0.76, 0.24}, 0.5), infinity);
  EXPECT_LT(coherence_bandwidth_hz(paths, std::vector{0.76, 0.24}, 0.9), infinity);
}

TEST(Coherence, ExponentialProfile) {
  // For p(tau) = e^{-tau/s}, sampled finely, |R| = 1/sqrt(1 + (2 pi s df)^2).
  const double spread = 100e-9;
  std::vector<Path> paths;
  std::vector<double> powers;
  for (int i = 0; i < 20'000; ++i) {
    paths.push_back(plain_path((i + 0.5) * spread / 1000, 1.0, false));
    powers.push_back(std::exp(-(i + 0.5) / 1000.0));
  }
  EXPECT_NEAR(coherence_bandwidth_hz(paths, powers, 0.5) * 2 * pi * spread, std::sqrt(3.0), 1e-5);
}

TEST(Coherence, WithoutSpreadOrPower) {
  const std::vector<Path> one{plain_path(1e-6)};
  EXPECT_EQ(coherence_bandwidth_hz(one, std::vector{1.0}, 0.5), infinity);
  EXPECT_EQ(coherence_time_s(one, std::vector{1.0}, 0.5), infinity);
  EXPECT_TRUE(std::isnan(coherence_bandwidth_hz(one, std::vector{0.0}, 0.5)));
  EXPECT_TRUE(std::isnan(coherence_time_s({}, {}, 0.5)));
}

TEST(Coherence, AnyOrderOfPathsGivesTheSameBits) {
  auto paths = random_paths(100, 1e-6, 2);
  const auto powers = [&] {
    std::vector<double> result;
    for (const Path& path : paths) result.push_back(std::norm(path.transfer[0]));
    return result;
  };
  const double bandwidth = coherence_bandwidth_hz(paths, powers(), 0.5);
  const double time = coherence_time_s(paths, powers(), 0.5);
  testing::shuffle(paths, 3);
  EXPECT_EQ(coherence_bandwidth_hz(paths, powers(), 0.5), bandwidth);
  EXPECT_EQ(coherence_time_s(paths, powers(), 0.5), time);
}

TEST(SubcarrierCount, OnesThatFitWholly) {
  EXPECT_EQ(subcarrier_count(20e6, 15e3), 1333u);
  EXPECT_EQ(subcarrier_count(0.3, 0.1), 3u);  // the quotient is 2.9999999999999996
  EXPECT_EQ(subcarrier_count(7.68e6, 30e3), 256u);
  EXPECT_EQ(subcarrier_count(30e3, 30e3), 1u);
  EXPECT_EQ(subcarrier_count(59.9e3, 30e3), 1u);
  EXPECT_THROW(subcarrier_count(29e3, 30e3), ContractError);
  EXPECT_THROW(subcarrier_count(-1e6, 30e3), ContractError);
  EXPECT_THROW(subcarrier_count(1e6, 0.0), ContractError);
  EXPECT_THROW(subcarrier_count(std::nan(""), 30e3), ContractError);
  EXPECT_THROW(subcarrier_count(1e12, 1.0), ContractError);
}

}  // namespace
}  // namespace greatx::rf
