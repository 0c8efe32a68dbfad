// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Closed forms of the models of followers and lane changes.
#include "sim/traffic/followers.h"

#include <cmath>

#include <gtest/gtest.h>

namespace greatx::sim {
namespace {

constexpr double step_s = 0.1;

/// At the equilibrium gap behind a leader of the same speed nothing changes.
TEST(Followers, KeepTheEquilibriumGap) {
  const Follower follower{15.0, 1.2, 1.8, 1.4, 2.0};
  for (const double speed : {0.0, 3.0, 8.0, 14.0}) {
    const double gap = equilibrium_gap(follower, speed);
    EXPECT_NEAR(idm_acceleration(follower, speed, gap, speed), 0.0, 1e-12);
    EXPECT_GT(idm_acceleration(follower, speed, 1.01 * gap, speed), 0.0);
    EXPECT_LT(idm_acceleration(follower, speed, 0.99 * gap, speed), 0.0);
  }
  EXPECT_DOUBLE_EQ(equilibrium_gap(follower, 0.0), 2.0);
}

/// On a free way dv/dt = a (1 - (v / v0)^4), whose inverse is an integral with a closed form:
/// t = v0 / a (atan(x) + atanh(x)) / 2, x = v / v0.
TEST(Followers, AccelerateFreely) {
  const Follower follower{12.0, 1.5, 2.0, 1.2, 2.0};
  const double v0 = follower.desired_mps, a = follower.acceleration_mps2;
  for (const double step : {0.1, 0.05}) {
    Progress state;
    const int steps = static_cast<int>(std::lround(6.0 / step));
    for (int i = 0; i < steps; ++i)
      state = advanced(state, free_acceleration(follower, state.speed_mps, v0), step);
    const double x = state.speed_mps / v0;
    const double expected_s = 0.5 * v0 / a * (std::atan(x) + std::atanh(x));
    // The ballistic update has an error of first order in the speed.
    EXPECT_NEAR(expected_s, 6.0, 1.5 * step);
  }
  EXPECT_EQ(free_acceleration(follower, v0, v0), 0.0);
  EXPECT_LT(free_acceleration(follower, 1.5 * v0, v0), 0.0);
  EXPECT_GT(free_acceleration(follower, 3.0 * v0, v0), -follower.braking_mps2);
}

/// From any speed and any distance at which one can stop, one stops before a standing obstacle.
TEST(Followers, NeverRunIntoAStandingObstacle) {
  const Follower follower{20.0, 1.5, 2.0, 1.2, 2.0};
  for (double speed = 1.0; speed <= 20.0; speed += 1.0)
    for (double room = 1.0; room <= 8.0; room *= 2.0) {
      Progress state{0.0, speed};
      const double wall = 2.0 + room * speed * speed / (2.0 * most_braking_mps2) + 0.5;
      double least = 1e9;
      for (int i = 0; i < 1000; ++i) {
        const double wanted = idm_acceleration(follower, state.speed_mps, wall - state.place_m, 0.0);
        state = advanced(state, std::max(wanted, -most_braking_mps2), step_s);
        least = std::min(least, wall - state.place_m);
        EXPECT_GE(state.speed_mps, 0.0);
      }
      EXPECT_GT(least, 0.0) << speed << " m/s, room " << room;
      EXPECT_LT(state.speed_mps, 0.05);
    }
}

TEST(Followers, StopAtTheEndOfTheStepInWhichTheyWouldStop) {
  const Progress state = advanced({10.0, 0.5}, -8.0, step_s);
  EXPECT_EQ(state.speed_mps, 0.0);
  EXPECT_NEAR(state.place_m, 10.025, 1e-15);
}

TEST(Followers, ChangeTheLaneIfItIsSafeAndWorthWhile) {
  LaneChange change{.own = -1.0, .own_after = 0.5};
  EXPECT_TRUE(changes_lane(change));
  change.new_follower_after = -2.5;  // would have to brake too hard
  EXPECT_FALSE(changes_lane(change));
  change.new_follower_after = -1.9;
  EXPECT_TRUE(changes_lane(change));
  EXPECT_FALSE(changes_lane({.own = 0.4, .own_after = 0.5}));
  // A gain of 0.3 is worth it unless others lose 0.6 by it, of which a fifth counts.
  EXPECT_TRUE(changes_lane({.own = 0.0, .own_after = 0.3}));
  EXPECT_FALSE(changes_lane({.own = 0.0, .own_after = 0.3, .new_follower = 0.0, .new_follower_after = -0.6}));
}

}  // namespace
}  // namespace greatx::sim
