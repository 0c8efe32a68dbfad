// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "sim/scenario/gait.h"

#include <cmath>

#include <gtest/gtest.h>

#include "core/vec.h"

namespace greatx::sim {
namespace {

const Walker adult{0.46, 0.48, 1.34};

Travel steady(double time_s, double speed_mps) { return {speed_mps * time_s, speed_mps, 0.0}; }

/// The sole of a leg from its joints alone: forward of the hips, and above the ground.
dvec2 sole(const Gait& gait, const Walker& walker, bool left, const Travel& travel) {
  // A positive turn about +y (to the left) swings a hanging limb backwards.
  const double thigh = -gait.joint(Limb::thigh, left, travel).value;
  const double shank = thigh - gait.joint(Limb::shank, left, travel).value;
  const double hips = walker.thigh_m + walker.shank_m - gait.drop(travel).value;
  return {walker.thigh_m * std::sin(thigh) + walker.shank_m * std::sin(shank),
          hips - walker.thigh_m * std::cos(thigh) - walker.shank_m * std::cos(shank)};
}

/// Boulic et al. (1990): a cycle is 1.346 sqrt(V / H) H long.
TEST(Gait, HasTheLengthOfTheModel) {
  EXPECT_NEAR(Gait(adult, 0.0).stride_m(), 1.346 * std::sqrt(1.34 / 0.94) * 0.94, 1e-12);
}

/// The joints put the soles where they belong: a planted sole stays on the ground and does not slide.
TEST(Gait, PlantsItsFeet) {
  const Gait gait(adult, 0.0);
  const double v = 1.34, cycle_s = gait.stride_m() / v;
  int planted = 0;
  for (int i = 0; i < 1000; ++i) {
    const double time_s = cycle_s * i / 1000.0;
    const Travel travel = steady(time_s, v);
    for (const bool left : {true, false}) {
      const dvec2 place = sole(gait, adult, left, travel);
      EXPECT_NEAR(place.x, gait.sole_forward(left, travel).value, 1e-12);
      EXPECT_NEAR(place.y, gait.sole_height(left, travel).value, 1e-12);
      EXPECT_GT(place.y, -1e-12);
      if (gait.sole_height(left, travel).value > 0.0) continue;
      ++planted;
      EXPECT_NEAR(gait.sole_forward(left, travel).rate, -v, 1e-12);  // still on the ground
    }
  }
  EXPECT_GE(planted, 1000);  // one foot or the other, always; both where they change
}

TEST(Gait, HasExactDerivatives) {
  const Gait gait(adult, 0.3);
  // Speeds up from standing through the range in which the steps grow.
  const auto travel_at = [](double t) { return Travel{0.4 * t * t, 0.8 * t, 0.8}; };
  const double h = 1e-5;
  const auto check = [&](const auto& of) {
    for (double t = 0.05; t < 2.5; t += 0.0371) {
      const Turned now = of(travel_at(t)), before = of(travel_at(t - h)), after = of(travel_at(t + h));
      EXPECT_NEAR(now.rate, (after.value - before.value) / (2 * h), 2e-6 * (1.0 + std::abs(now.rate))) << t;
      EXPECT_NEAR(now.acceleration, (after.rate - before.rate) / (2 * h),
                  2e-4 * (1.0 + std::abs(now.acceleration)))
          << t;
    }
  };
  for (const Limb limb : {Limb::thigh, Limb::shank, Limb::upper_arm, Limb::forearm})
    for (const bool left : {true, false})
      check([&](const Travel& travel) { return gait.joint(limb, left, travel); });
  check([&](const Travel& travel) { return gait.drop(travel); });
}

/// One who stands has straight legs and hanging arms, wherever in a step.
TEST(Gait, RestsWhenStanding) {
  const Gait gait(adult, 0.0);
  for (double distance = 0.0; distance < 2.0; distance += 0.1) {
    const Travel travel{distance, 0.0, 0.0};
    EXPECT_NEAR(gait.joint(Limb::thigh, true, travel).value, 0.0, 0.1);
    EXPECT_NEAR(gait.joint(Limb::shank, true, travel).value, 0.0, 0.15);
    EXPECT_EQ(gait.joint(Limb::upper_arm, true, travel).value, 0.0);
    EXPECT_LT(gait.drop(travel).value, 0.003);
    EXPECT_EQ(gait.joint(Limb::thigh, true, travel).rate, 0.0);
  }
}

/// Feet slide only below full_speed_mps, where the steps shrink: in a stop or a start by no more than half a
/// step.
TEST(Gait, SlidesLittleInAStop) {
  const Gait gait(adult, 0.0);
  const double brake = 1.0, from = Gait::full_speed_mps;
  for (int phase = 0; phase < 20; ++phase) {
    double slid = 0.0;
    const double start_m = gait.stride_m() * phase / 20.0, h = 1e-3;
    for (double t = 0.0; t < from / brake; t += h) {
      const Travel travel{start_m + from * t - 0.5 * brake * t * t, from - brake * t, -brake};
      double least = 1e9;  // of the foot that is planted
      for (const bool left : {true, false})
        if (gait.sole_height(left, travel).value < 1e-9)
          least = std::min(least, std::abs(travel.speed_mps + gait.sole_forward(left, travel).rate));
      slid += least * h;
    }
    EXPECT_LT(slid, 0.25 * gait.stride_m() + 0.08) << phase;
  }
}

TEST(Gait, StaysInItsRange) {
  for (const Walker& walker : {adult, Walker{0.25, 0.33, 0.9}, Walker{0.5, 0.4, 2.0}})
    for (const Limb limb : {Limb::thigh, Limb::shank, Limb::upper_arm, Limb::forearm}) {
      const Gait gait(walker, 0.17);
      const Gait::Range range = Gait::range(walker, limb);
      EXPECT_LT(range.most - range.least, 2.2);
      for (int i = 0; i < 2000; ++i) {
        const double angle = gait.joint(limb, i % 2 == 0, {0.00317 * i, 0.0011 * i, 0.0}).value;
        EXPECT_TRUE(angle >= range.least && angle <= range.most) << angle;
      }
    }
}

}  // namespace
}  // namespace greatx::sim
