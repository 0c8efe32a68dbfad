// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "sim/run/schedule.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace greatx::sim {
namespace {

/// Returns the due ticks by the definition, tick by tick.
std::vector<int64_t> ticks_with_something_due(const Schedule& schedule, int64_t end) {
  std::vector<int64_t> ticks;
  for (int64_t tick = 0; tick < end; ++tick)
    if (!schedule.due(tick, 0).empty()) ticks.push_back(tick);
  return ticks;
}

TEST(Schedule, NextAndPreviousAgreeWithDue) {
  Schedule schedule(Rational::make(1000, 1));
  schedule.add(Rational::make(30, 1));
  schedule.add(Rational::make(30000, 1001));
  schedule.add(Rational::make(7, 3));
  constexpr int64_t end = 3000;
  const std::vector<int64_t> expected = ticks_with_something_due(schedule, end);
  std::vector<int64_t> found;
  for (int64_t tick = schedule.next(0, end); tick < end; tick = schedule.next(tick + 1, end))
    found.push_back(tick);
  EXPECT_EQ(found, expected);
  for (size_t i = 0; i < expected.size(); ++i)
    EXPECT_EQ(schedule.previous(expected[i]), i == 0 ? -1 : expected[i - 1]);
}

TEST(Schedule, LastOfASensorAgreesWithDue) {
  Schedule schedule(Rational::make(1000, 1));
  schedule.add(Rational::make(30, 1));
  schedule.add(std::nullopt);
  schedule.add(Rational::make(7, 3));
  std::vector<int64_t> last(3, -1);
  for (int64_t tick = 0; tick < 1000; ++tick) {
    for (const Due& due : schedule.due(tick, 0)) last[due.sensor] = tick;
    for (uint32_t sensor = 0; sensor < last.size(); ++sensor)
      ASSERT_EQ(schedule.last_of(sensor, tick), last[sensor]) << "sensor " << sensor << ", tick " << tick;
  }
  EXPECT_EQ(schedule.last_of(0, -1), -1);
}

TEST(Schedule, NothingAddedIsNeverDue) {
  const Schedule schedule(Rational::make(1000, 1));
  EXPECT_EQ(schedule.next(0, 50), 50);
  EXPECT_EQ(schedule.previous(50), -1);
  EXPECT_TRUE(schedule.due(0, 0).empty());
}

TEST(Schedule, DueNamesTheSample) {
  Schedule schedule(Rational::make(1000, 1));
  schedule.add(Rational::make(10, 1));
  schedule.add(Rational::make(30, 1));
  const std::vector<Due> due = schedule.due(100, 0);
  ASSERT_EQ(due.size(), 2u);
  EXPECT_EQ(due[0].sample, 1);
  EXPECT_EQ(due[1].sample, 3);
  EXPECT_EQ(schedule.due(33, 0).size(), 1u);
  EXPECT_TRUE(schedule.due(34, 0).empty());
}

TEST(Schedule, ASensorWithoutARateFiresWheneverAnotherOneDoes) {
  Schedule schedule(Rational::make(1000, 1));
  schedule.add(std::nullopt);
  EXPECT_EQ(schedule.next(0, 50), 50) << "it follows nothing";
  EXPECT_TRUE(schedule.due(0, 0).empty());
  schedule.add(Rational::make(10, 1));
  schedule.add(std::nullopt);
  schedule.add(Rational::make(30, 1));
  EXPECT_TRUE(schedule.due(34, 2).empty());
  const auto fired = [&](int64_t tick, int64_t before) {
    std::vector<std::pair<uint32_t, int64_t>> all;
    for (const Due& due : schedule.due(tick, before)) all.emplace_back(due.sensor, due.sample);
    return all;
  };
  using ::testing::ElementsAre, ::testing::Pair;
  EXPECT_THAT(fired(33, 1), ElementsAre(Pair(0u, 1), Pair(2u, 1), Pair(3u, 1)));
  EXPECT_THAT(fired(100, 3), ElementsAre(Pair(0u, 3), Pair(1u, 1), Pair(2u, 3), Pair(3u, 3)));
}

}  // namespace
}  // namespace greatx::sim
