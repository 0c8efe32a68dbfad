// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "sim/scenario/gait.h"

#include <cmath>

#include <gtest/gtest.h>

#include "core/error.h"
#include "core/units.h"
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

/// The axle of a pedal, from the joints of a leg alone: forward of the hips and down from them.
dvec2 pedal(const Cyclist& who, double thigh, double shank) {
  // A positive turn about +y swings a hanging limb backwards.
  const double t = -thigh, s = -(thigh + shank), below = who.shank_m + who.pedal_m;
  return {who.thigh_m * std::sin(t) + below * std::sin(s) + who.ball_m * std::cos(s),
          who.thigh_m * std::cos(t) + below * std::cos(s) - who.ball_m * std::sin(s)};
}

/// The balls of both feet go round with the pedals, on a circle of the cranks' length about their axle.
TEST(Pedalling, KeepsTheFeetOnThePedals) {
  Cyclist who;
  who.rest = 0.9;
  const Pedalling pedalling(who, 0.0);
  for (const bool left : {true, false}) {
    const double side = left ? 1.0 : -1.0;
    const auto place = [&](double crank) {
      return dvec2(who.forward_m + side * who.crank_m * std::cos(crank),
                   who.down_m + side * who.crank_m * std::sin(crank));
    };
    // The angles at rest, by the law of cosines in the triangle of hip, knee and axle.
    const dvec2 rest = place(who.rest);
    const double far = glm::length(rest), below = who.shank_m + who.pedal_m,
                 lower = std::hypot(below, who.ball_m);
    const auto angle = [](double a, double b, double opposite) {
      return std::acos((a * a + b * b - opposite * opposite) / (2.0 * a * b));
    };
    const double thigh0 = -(std::atan2(rest.x, rest.y) + angle(far, who.thigh_m, lower)),
                 shank0 = pi - angle(who.thigh_m, lower, far) + std::atan2(who.ball_m, below);
    EXPECT_LT(glm::distance(pedal(who, thigh0, shank0), rest), 1e-12);
    for (int i = 0; i < 500; ++i) {
      const Travel travel{who.development_m * i / 100.0, 4.0, 0.0};
      const Turned crank = pedalling.crank(travel);
      EXPECT_NEAR(crank.rate, 2.0 * pi * 4.0 / who.development_m, 1e-12);
      EXPECT_NEAR(std::remainder(crank.value + who.rest - 2.0 * pi * i / 100.0, 2.0 * pi), 0.0, 1e-9);
      const double thigh = thigh0 + pedalling.joint(Limb::thigh, left, travel).value,
                   shank = shank0 + pedalling.joint(Limb::shank, left, travel).value;
      EXPECT_LT(glm::distance(pedal(who, thigh, shank), place(crank.value + who.rest)), 1e-12) << i;
      EXPECT_GT(shank, 0.0) << "a knee bends backwards only";
    }
  }
}

TEST(Pedalling, HasExactDerivatives) {
  const Pedalling pedalling(Cyclist{}, 0.3);
  const auto travel_at = [](double t) { return Travel{0.4 * t * t, 0.8 * t, 0.8}; };
  const double h = 1e-5;
  for (const Limb limb : {Limb::thigh, Limb::shank})
    for (const bool left : {true, false})
      for (double t = 0.05; t < 6.0; t += 0.0371) {
        const auto at = [&](double s) { return pedalling.joint(limb, left, travel_at(s)); };
        const Turned now = at(t);
        EXPECT_NEAR(now.rate, (at(t + h).value - at(t - h).value) / (2 * h), 1e-6);
        EXPECT_NEAR(now.acceleration, (at(t + h).rate - at(t - h).rate) / (2 * h), 1e-4);
        const Gait::Range range = Pedalling::range(Cyclist{}, limb);
        EXPECT_GT(now.value, range.least);
        EXPECT_LT(now.value, range.most);
      }
}

TEST(Pedalling, RefusesLegsThatAreTooShort) {
  Cyclist who;
  who.thigh_m = 0.3;
  EXPECT_THROW(Pedalling::range(who, Limb::thigh), UserError);
}

}  // namespace
}  // namespace greatx::sim
