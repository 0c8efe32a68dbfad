// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// What the times of ticks add up to.
#include "view/times/time_history.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace greatx::view {
namespace {

using sim::TimeRow;
using testing::HasSubstr;

std::vector<SensorSpec> sensors() {
  std::vector<SensorSpec> specs(2);
  specs[0].name = "uav/front";
  specs[1].name = "uav/radar";
  return specs;
}

ShownTick tick_of(int64_t tick, double wall_ms, std::vector<TimeRow> rows) {
  ShownTick shown;
  shown.packet.tick = tick;
  shown.simulated_ms = wall_ms;
  auto times = std::make_shared<sim::TickTimes>();
  times->rows = std::move(rows);
  times->simulated_ms = 10.0;
  shown.times = times;
  return shown;
}

TEST(TimeHistory, SumsByPartAndByLine) {
  TimeHistory history;
  history.add(tick_of(0, 80.0,
                      {{"record", TimeRow::shared, false, 1, 1.0},
                       {"uav/front visibility", 0, true, 1, 10.0},
                       {"radar echoes", 1, true, 2, 40.0},
                       {"collect", 1, false, 1, 12.0},
                       {"wait", TimeRow::shared, false, 1, 50.0}}),
              sensors());
  history.add(
      tick_of(1, 20.0,
              {{"record", TimeRow::shared, false, 1, 3.0}, {"uav/front visibility", 0, true, 1, 14.0}}),
      sensors());
  history.sum_up();
  ASSERT_EQ(history.parts().size(), 3u);
  ASSERT_EQ(history.lines().size(), 4u);
  EXPECT_EQ(history.lines()[0].name, "radar echoes");
  EXPECT_EQ(history.lines()[0].ticks, 1u);
  EXPECT_EQ(history.lines()[0].count, 0u) << "it did not run in the present tick";
  EXPECT_DOUBLE_EQ(history.lines()[0].median_ms, 40.0);
  EXPECT_DOUBLE_EQ(history.lines()[0].mean_ms, 20.0);
  EXPECT_EQ(history.lines()[1].name, "visibility") << "without its sensor's name";
  EXPECT_EQ(history.lines()[2].name, "results");
  EXPECT_DOUBLE_EQ(history.lines()[1].now_ms, 14.0);
  EXPECT_EQ(history.parts()[history.lines()[1].part].name, "uav/front");
  EXPECT_DOUBLE_EQ(history.mean_work_ms(), 40.0) << "without waiting";
  EXPECT_DOUBLE_EQ(history.mean_wait_ms(), 25.0);
  EXPECT_EQ(history.ticks()[1].part_ms.size(), 3u);
  EXPECT_EQ(
      history.answer(),
      "uav/radar takes 65 % of the work of a tick (26 ms of 40 ms). Its longest step is 'radar echoes' on "
      "the device: 20 ms. A tick takes 50 ms for 10 ms of simulated time, which is 0.20 x real time.");
}

TEST(TimeHistory, TheStartOfASequenceIsNoTimeOfATick) {
  ShownTick tick = tick_of(0, 5000.0, {});
  auto times = std::make_shared<sim::TickTimes>(*tick.times);
  times->start_ms = 4900.0;
  tick.times = times;
  TimeHistory history;
  history.add(tick, sensors());
  history.sum_up();
  EXPECT_DOUBLE_EQ(history.ticks()[0].wall_ms, 100.0);
  EXPECT_DOUBLE_EQ(history.ticks()[0].start_ms, 4900.0);
}

TEST(TimeHistory, ATickThatIsShownAgainCountsOnce) {
  TimeHistory history;
  const ShownTick first = tick_of(0, 5.0, {{"uav/front shade", 0, true, 1, 4.0}});
  history.add(first, sensors());
  history.add(tick_of(1, 5.0, {{"uav/front shade", 0, true, 1, 8.0}}), sensors());
  history.add(first, sensors());
  history.sum_up();
  EXPECT_EQ(history.ticks().size(), 2u);
  EXPECT_EQ(history.present(), 0u);
  EXPECT_DOUBLE_EQ(history.lines()[0].now_ms, 4.0);
}

TEST(TimeHistory, KeepsTheLastTicksAlone) {
  TimeHistory history;
  for (int64_t tick = 0; tick < 500; ++tick)
    history.add(tick_of(tick, 1.0, {{"uav/front shade", 0, true, 1, 1.0}}), sensors());
  history.sum_up();
  EXPECT_EQ(history.ticks().size(), TimeHistory::most_ticks);
  EXPECT_EQ(history.ticks().back().tick, 499);
  EXPECT_EQ(history.present(), TimeHistory::most_ticks - 1);
}

TEST(TimeHistory, ADataSetHasNoRows) {
  TimeHistory history;
  history.sum_up();
  EXPECT_THAT(history.answer(), HasSubstr("No tick"));
  ShownTick read;
  read.simulated_ms = 3.0;
  history.add(read, sensors());
  history.sum_up();
  EXPECT_TRUE(history.lines().empty());
  EXPECT_DOUBLE_EQ(history.median_wall_ms(), 3.0);
  EXPECT_THAT(history.answer(), HasSubstr("time of reading"));
}

TEST(TimeHistory, TimesHaveTwoDigitsOrMore) {
  EXPECT_EQ(milliseconds_text(0.4249), "0.42 ms");
  EXPECT_EQ(milliseconds_text(7.14), "7.1 ms");
  EXPECT_EQ(milliseconds_text(9.97), "10 ms");
  EXPECT_EQ(milliseconds_text(152.4), "152 ms");
}

}  // namespace
}  // namespace greatx::view
