// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "sim/scenario/clock.h"

#include <limits>

#include <gtest/gtest.h>

#include "core/error.h"

namespace greatx::sim {
namespace {

TEST(HardCase, N58_AnHourOfMillisecondTicksDoesNotDrift) {
  const Clock clock(Rational{1000, 1});
  const int64_t hour = 3'600'000;
  EXPECT_EQ(clock.seconds(hour), 3600.0);
  EXPECT_EQ(clock.nanoseconds(hour), 3'600'000'000'000);
  for (int64_t tick = 0; tick <= hour; ++tick) {
    ASSERT_EQ(clock.nanoseconds(tick), tick * 1'000'000);
    ASSERT_EQ(clock.seconds(tick), static_cast<double>(tick) / 1000.0);
  }
}

TEST(HardCase, N59_ThirtyHertzOnMillisecondTicks) {
  const SampleTimes times(Rational{1000, 1}, Rational{30, 1});
  const int64_t first[] = {0, 33, 67, 100, 133, 167, 200};
  for (int64_t k = 0; k < 7; ++k) EXPECT_EQ(times.tick_of(k), first[k]);
  EXPECT_EQ(times.tick_of(108'000), 3'600'000);
  // 108 000 intervals have 108 001 samples, which come one after the other.
  int64_t fired = 0;
  for (int64_t tick = 0; tick <= 3'600'000; ++tick) {
    const int64_t sample = times.sample_at(tick);
    if (sample < 0) continue;
    ASSERT_EQ(sample, fired);
    ASSERT_EQ(times.tick_of(sample), tick);
    ++fired;
  }
  EXPECT_EQ(fired, 108'001);
}

TEST(Clock, RationalTicks) {
  const Clock clock(Rational{30000, 1001});
  EXPECT_EQ(clock.nanoseconds(1), 33'366'667);  // 33 366 666.67
  EXPECT_EQ(clock.nanoseconds(2), 66'733'333);  // 66 733 333.33
  EXPECT_EQ(clock.nanoseconds(30'000), 1001'000'000'000);
  EXPECT_EQ(clock.seconds(30'000), 1001.0);
  EXPECT_EQ(clock.seconds(1), 1001.0 / 30000.0);
}

TEST(Clock, HalfNanosecondsRoundUp) {
  const Clock clock(Rational{2'000'000'000, 1});
  EXPECT_EQ(clock.nanoseconds(1), 1);
  EXPECT_EQ(clock.nanoseconds(2), 1);
  EXPECT_EQ(clock.nanoseconds(3), 2);
  EXPECT_EQ(clock.nanoseconds(-1), 0);
  EXPECT_EQ(clock.nanoseconds(-3), -1);
}

TEST(Clock, LargeTimesStayExactAndOverflowIsSeen) {
  const Clock clock(Rational{1000, 1});
  const int64_t years = 9'000'000'000'000;  // 285 years of milliseconds
  EXPECT_EQ(clock.nanoseconds(years + 1) - clock.nanoseconds(years), 1'000'000);
  EXPECT_THROW(clock.nanoseconds(std::numeric_limits<int64_t>::max()), ContractError);
  EXPECT_NEAR(clock.seconds(std::numeric_limits<int64_t>::max()), 9.223372036854775807e15, 1.0);
}

TEST(SampleTimes, EveryTickAtTheTickRate) {
  const SampleTimes times(Rational{30000, 1001}, Rational{30000, 1001});
  for (int64_t tick = 0; tick < 100; ++tick) EXPECT_EQ(times.sample_at(tick), tick);
  EXPECT_EQ(times.sample_at(-1), -1);
}

TEST(SampleTimes, HalvesRoundUp) {
  const SampleTimes times(Rational{3, 1}, Rational{2, 1});  // 0, 1.5, 3, 4.5, ...
  EXPECT_EQ(times.tick_of(1), 2);
  EXPECT_EQ(times.tick_of(2), 3);
  EXPECT_EQ(times.tick_of(3), 5);
  EXPECT_EQ(times.sample_at(1), -1);
  EXPECT_EQ(times.sample_at(2), 1);
}

TEST(SampleTimes, SampleAtInvertsTickOfForManyRates) {
  const Rational tick_rates[] = {{1000, 1}, {30000, 1001}, {997, 13}};
  const Rational rates[] = {{10, 1}, {2997, 100}, {24000, 1001}, {1, 7}, {23, 1}};
  for (const Rational& tick_rate : tick_rates)
    for (const Rational& rate : rates) {
      if (less(tick_rate, rate)) continue;
      const SampleTimes times(tick_rate, rate);
      int64_t next = 0;
      for (int64_t tick = 0; tick < 5000; ++tick) {
        const bool fires = times.tick_of(next) == tick;
        ASSERT_EQ(times.first_at_or_after(tick), next) << tick_rate.str() << " " << rate.str() << " " << tick;
        ASSERT_EQ(times.sample_at(tick), fires ? next : -1)
            << tick_rate.str() << " " << rate.str() << " " << tick;
        next += fires;
      }
    }
}

TEST(SampleTimes, FasterThanTheTicksIsABrokenContract) {
  EXPECT_THROW(SampleTimes(Rational{1000, 1}, Rational{1001, 1}), ContractError);
}

TEST(SampleTimes, RatesTooFineForIntegersAreRefused) {
  constexpr int64_t prime = 9223372036854775783;
  EXPECT_THROW(SampleTimes(Rational{prime, 2}, Rational{5, 7}), UserError);
}

}  // namespace
}  // namespace greatx::sim
