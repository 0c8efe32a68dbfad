// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Every unit of a run goes to one process.
#include <set>
#include <sys/wait.h>
#include <unistd.h>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "apps/campaign/queue.h"

namespace greatx::apps {
namespace {

using Unit = std::pair<size_t, uint32_t>;

std::vector<CampaignUnit> units_of(size_t cells, uint32_t sequences) {
  std::vector<CampaignUnit> units;
  for (size_t cell = 0; cell < cells; ++cell)
    for (uint32_t s = 0; s < sequences; ++s) units.push_back({cell, s});
  return units;
}

TEST(WorkQueue, RangesHoldEveryUnitOnceAndOneCellEach) {
  for (const size_t cells : {0u, 1u, 2u, 5u, 24u})
    for (const uint32_t sequences : {1u, 3u, 4u, 150u})
      for (const uint32_t takers : {1u, 2u, 7u}) {
        const std::vector<CampaignUnit> all = units_of(cells, sequences);
        const WorkQueue queue(all, takers);
        std::set<Unit> taken;
        for (auto range = queue.take(); !range.empty(); range = queue.take())
          for (const CampaignUnit& unit : range) {
            EXPECT_TRUE(taken.insert({unit.cell, unit.sequence}).second);
            EXPECT_TRUE(takers == 1 || unit.cell == range.front().cell);
          }
        EXPECT_EQ(taken.size(), all.size());
        EXPECT_TRUE(queue.take().empty());
      }
}

TEST(WorkQueue, TheLastCellsAreSplit) {
  EXPECT_EQ(WorkQueue(units_of(24, 150), 1).ranges(), 1u);
  EXPECT_EQ(WorkQueue(units_of(24, 150), 2).ranges(), 22u + 2u * 8u);
  EXPECT_EQ(WorkQueue(units_of(24, 4), 2).ranges(), 24u) << "a piece has four units at least";
  EXPECT_EQ(WorkQueue(units_of(1, 16), 2).ranges(), 4u);
}

TEST(WorkQueue, ForkedProcessesShareWhatIsTaken) {
  const WorkQueue queue(units_of(200, 1), 4);
  int ends[2];
  ASSERT_EQ(pipe(ends), 0);
  for (int i = 0; i < 4; ++i)
    if (fork() == 0) {
      for (auto range = queue.take(); !range.empty(); range = queue.take()) {
        const uint32_t cell = static_cast<uint32_t>(range.front().cell);
        if (write(ends[1], &cell, sizeof cell) != sizeof cell) _exit(1);
      }
      _exit(0);
    }
  close(ends[1]);
  std::multiset<uint32_t> taken;
  for (uint32_t cell = 0; read(ends[0], &cell, sizeof cell) == sizeof cell;) taken.insert(cell);
  close(ends[0]);
  for (int i = 0; i < 4; ++i) {
    int status = 1;
    wait(&status);
    EXPECT_EQ(status, 0);
  }
  EXPECT_EQ(taken.size(), 200u);
  EXPECT_EQ(std::set<uint32_t>(taken.begin(), taken.end()).size(), 200u);
}

}  // namespace
}  // namespace greatx::apps
