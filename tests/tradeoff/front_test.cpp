// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "sim/tradeoff/front.h"

#include <cmath>
#include <limits>
#include <random>

#include <gtest/gtest.h>

#include "sim/tradeoff/measure.h"

namespace greatx::sim {
namespace {

std::vector<FrontKnob> random_knobs(std::mt19937& random, size_t count) {
  std::uniform_real_distribution<double> uniform(0.0, 1.0);
  std::vector<FrontKnob> knobs(count);
  for (FrontKnob& knob : knobs)
    for (int s = 0; s < 4; ++s)
      knob.settings.push_back({8.0 + 2.0 * uniform(random), std::pow(10.0, -4.0 * uniform(random))});
  return knobs;
}

/// All joint settings.
std::vector<FrontPoint> all_points(double own_ms, const std::vector<FrontKnob>& knobs) {
  std::vector<FrontPoint> points(1);
  for (const FrontKnob& knob : knobs) {
    std::vector<FrontPoint> next;
    for (const FrontPoint& point : points)
      for (size_t s = 0; s < knob.settings.size(); ++s)
        next.push_back(joined(point, own_ms, knob.settings[s], s));
    points = std::move(next);
  }
  return points;
}

TEST(Front, IsThatOfAllJointSettings) {
  std::mt19937 random(3);
  for (int round = 0; round < 20; ++round) {
    const std::vector<FrontKnob> knobs = random_knobs(random, 5);
    const std::vector<FrontPoint> all = all_points(10.0, knobs), front = front_of(10.0, knobs, 100000);
    ASSERT_FALSE(front.empty());
    // Nothing beats a point of the front, and each other setting is beaten or equalled by one of it.
    for (const FrontPoint& point : all) {
      bool covered = false;
      for (const FrontPoint& kept : front) {
        EXPECT_FALSE(point.ms < kept.ms && point.power < kept.power);
        covered |= kept.ms <= point.ms && kept.power <= point.power;
      }
      EXPECT_TRUE(covered);
    }
  }
}

TEST(Front, CostlyKnobsAreLimitedTheLeastImportantFirst) {
  const auto knob = [](double own_power, double factor) {
    FrontKnob front{{{1.0, 0.5}, {10.0, own_power}, {10.0 * factor, 0.0}}, 1, 2, factor};
    return front;
  };
  std::vector<FrontKnob> knobs{knob(1e-2, 10.0), knob(1e-5, 1.5), knob(1e-4, 8.0), knob(1e-3, 5.0)};
  // 10 * 1.5 * 8 * 5 = 600; without the third one 75.
  EXPECT_EQ(limit_costly(knobs, 600.0), std::vector<size_t>{});
  EXPECT_EQ(limit_costly(knobs, 100.0), std::vector<size_t>{2});
  EXPECT_EQ(knobs[2].reference, 1u);
  EXPECT_EQ(knobs[2].settings[1].power, 0.0) << "the new reference";
  EXPECT_DOUBLE_EQ(knobs[2].settings[0].power, 0.5 - 1e-4);
  EXPECT_EQ(knobs[2].settings[2].power, std::numeric_limits<double>::infinity());
  // No joint setting of the front has what is out.
  for (const FrontPoint& point : front_of(10.0, knobs)) EXPECT_NE(point.choice[2], 2u);
  // A last costly knob may take four times the limit; the one that costs little stays.
  EXPECT_EQ(limit_costly(knobs, 4.0), std::vector<size_t>{3});
  EXPECT_EQ(limit_costly(knobs, 1.0), std::vector<size_t>{0});
  EXPECT_EQ(knobs[1].reference, 2u);
  std::vector<FrontKnob> none;
  EXPECT_TRUE(limit_costly(none, 0.0).empty());
}

TEST(Front, ThinnedKeepsBothEndsAndOrder) {
  std::mt19937 random(5);
  const std::vector<FrontPoint> front = front_of(10.0, random_knobs(random, 6), 100000);
  ASSERT_GT(front.size(), 9u);
  const std::vector<FrontPoint> thin = thinned(front, 8);
  ASSERT_EQ(thin.size(), 8u);
  EXPECT_EQ(thin.front().choice, front.front().choice);
  EXPECT_EQ(thin.back().choice, front.back().choice);
  for (size_t i = 1; i < thin.size(); ++i) {
    EXPECT_GT(thin[i].ms, thin[i - 1].ms);
    EXPECT_LT(thin[i].power, thin[i - 1].power);
  }
}

TEST(Front, SlowerSettingsAddAndFasterOnesMultiply) {
  FrontPoint point;
  for (const double ms : {30.0, 20.0, 5.0, 8.0}) point = joined(point, 10.0, {ms, 0.01}, 0);
  EXPECT_NEAR(point.ms, (10.0 + 20.0 + 10.0) * 0.5 * 0.8, 1e-12);
  EXPECT_NEAR(point.power, 0.04, 1e-15);
}

TEST(Front, ErrorsAddAsPowers) {
  EXPECT_NEAR(error_of_power(error_power(-30.0, true) + error_power(-30.0, true), true), -26.99, 0.01);
  EXPECT_NEAR(error_of_power(error_power(3.0, false) + error_power(4.0, false), false), 5.0, 1e-12);
  EXPECT_EQ(error_power(-std::numeric_limits<double>::infinity(), true), 0.0);
}

TEST(Spread, MedianAndQuartiles) {
  const Spread spread = spread_of({5.0, 1.0, 2.0, 4.0, 3.0});
  EXPECT_EQ(spread.median, 3.0);
  EXPECT_EQ(spread.low, 2.0);
  EXPECT_EQ(spread.high, 4.0);
  EXPECT_EQ(spread.count, 5u);
  EXPECT_EQ(spread_of({}).count, 0u);
}

}  // namespace
}  // namespace greatx::sim
