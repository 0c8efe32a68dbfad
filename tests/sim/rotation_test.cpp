// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "sim/scenario/rotation.h"

#include <cmath>

#include <gtest/gtest.h>

namespace greatx::sim {
namespace {

TEST(HardCase, N58_RotorsDoNotDriftInAnHour) {
  // 90 turns per second on millisecond ticks are 9/100 of a turn per tick. The same hundred angles repeat for
  // ever, exact to the bit.
  const Rational tick_rate{1000, 1};
  const Clock clock(tick_rate);
  const Rotation rotor(tick_rate, {{90, 1}, false}, 0.0);
  const int64_t hour = 3'600'000;
  for (int64_t tick = 0; tick < 300; ++tick) {
    const double expected = static_cast<double>(tick * 9 % 100) / 100.0;
    ASSERT_EQ(rotor.turns(clock.seconds(tick)), expected) << tick;
    ASSERT_EQ(rotor.turns(clock.seconds(hour + tick)), expected) << tick;
    ASSERT_EQ(rotor.turns(clock.seconds(100'000 * hour + tick)), expected) << tick;  // eleven years
  }
  // The rate is no binary fraction, and the ticks are those of broadcast video: 1000/7 * 1001/30000 = 143/30
  // turns per tick.
  const Rational video{30000, 1001};
  const Rotation odd(video, {{1000, 7}, false}, 0.0);
  for (const int64_t tick : {0, 1, 29, 30, 107'892'107, 107'892'120})
    EXPECT_EQ(odd.turns(Clock(video).seconds(tick)), static_cast<double>(tick % 30 * 143 % 30) / 30.0)
        << tick;
}

TEST(Rotation, GoesOnEvenlyBetweenTicks) {
  const Rational tick_rate{10, 1};
  const Rotation rotor(tick_rate, {{30, 1}, false}, 0.125);
  for (const double time_s : {0.0, 0.001, 0.049, 0.051, 0.1, 7.003, -0.002}) {
    const double turns = 0.125 + 30.0 * time_s;
    EXPECT_NEAR(rotor.turns(time_s), turns - std::floor(turns), 1e-13) << time_s;
  }
  // The angle is continuous across the middle between two ticks, where the nearest tick changes.
  const double before = rotor.turns(std::nextafter(3600.05, 0.0)),
               after = rotor.turns(std::nextafter(3600.05, 1e9));
  EXPECT_NEAR(after - before, 0.0, 1e-10);
  EXPECT_GE(rotor.turns(-1e-19), 0.0);
  EXPECT_LT(rotor.turns(-1e-19), 1.0);
}

TEST(Rotation, ANegativeRateIsTheMirrorImage) {
  const Rational tick_rate{1000, 1};
  const Rotation left(tick_rate, {{87, 1}, false}, 0.0), right(tick_rate, {{87, 1}, true}, 0.0);
  EXPECT_EQ(left.rate_hz(), 87.0);
  EXPECT_EQ(right.rate_hz(), -87.0);
  for (const double time_s : {0.001, 0.0123, 3599.999})
    EXPECT_NEAR(left.turns(time_s) + right.turns(time_s), 1.0, 1e-15) << time_s;
}

}  // namespace
}  // namespace greatx::sim
