// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "tests/view/run_support.h"

#include <fmt/format.h>

namespace greatx::view {

void expect_same_record(const Record& wanted, const Record& found, const std::string& what) {
  EXPECT_EQ(wanted.sensor, found.sensor) << what;
  EXPECT_EQ(wanted.tick, found.tick) << what;
  EXPECT_EQ(wanted.time_ns, found.time_ns) << what;
  EXPECT_EQ(wanted.sample, found.sample) << what;
  ASSERT_EQ(wanted.arrays.size(), found.arrays.size()) << what;
  for (size_t i = 0; i < wanted.arrays.size(); ++i) {
    EXPECT_EQ(wanted.arrays[i].dtype, found.arrays[i].dtype) << what << ", array " << i;
    EXPECT_EQ(wanted.arrays[i].shape, found.arrays[i].shape) << what << ", array " << i;
    EXPECT_TRUE(wanted.arrays[i].bytes == found.arrays[i].bytes) << what << ", array " << i;
  }
}

void expect_shown(const Packet& wanted, const std::vector<Packet>& before, const ShownTick& shown,
                  bool may_lack) {
  const std::string what = fmt::format("sequence {}, tick {}", shown.sequence, wanted.tick);
  ASSERT_EQ(wanted.tick, shown.packet.tick) << what;
  EXPECT_EQ(wanted.time_ns, shown.packet.time_ns) << what;
  ASSERT_EQ(wanted.records.size(), shown.packet.records.size()) << what;
  std::vector<const Record*> newest(shown.newest.size());
  for (const Packet& packet : before)
    if (packet.tick < wanted.tick)
      for (const Record& record : packet.records) newest.at(record.sensor) = &record;
  std::vector<bool> due(newest.size());
  for (size_t i = 0; i < wanted.records.size(); ++i) {
    expect_same_record(wanted.records[i], shown.packet.records[i], what);
    newest.at(wanted.records[i].sensor) = &wanted.records[i];
    due[wanted.records[i].sensor] = true;
  }
  for (size_t sensor = 0; sensor < newest.size(); ++sensor) {
    if (newest[sensor] == nullptr) {
      EXPECT_EQ(shown.newest[sensor], nullptr) << what << ", sensor " << sensor;
    } else if (shown.newest[sensor] == nullptr) {
      EXPECT_TRUE(may_lack && !due[sensor]) << what << ": the newest record of sensor " << sensor << " lacks";
    } else {
      expect_same_record(*newest[sensor], *shown.newest[sensor], what + ", newest");
    }
  }
}

}  // namespace greatx::view
