// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Replays data sets that are whole, unfinished, empty and damaged.
#include "view/run/replay.h"

#include <algorithm>

#include <gmock/gmock.h>

#include "tests/io/sample_run.h"
#include "tests/support/temporary_folder.h"
#include "tests/view/run_support.h"

namespace greatx::view {
namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;

class Replay : public testing::Test {
 protected:
  fs::path set() const { return temporary_.path() / "set"; }
  void write(int64_t packets = 0) const {
    io::DatasetWriter writer(set(), info_);
    EXPECT_EQ(io::write_sample_run(writer, info_, packets), packets == 0);
  }
  std::vector<Packet> packets(uint32_t sequence) const {
    std::vector<Packet> all;
    for (int64_t tick = 0; tick < info_.ticks_per_sequence; ++tick)
      all.push_back(io::sample_packet(info_, sequence, tick));
    return all;
  }
  void expect_tick(const view::Run& run, uint32_t sequence, int64_t tick) const {
    ASSERT_TRUE(wait_for_tick(run, sequence, tick));
    expect_shown(packets_.at(sequence).at(static_cast<size_t>(tick)), packets_[sequence], *run.shown());
  }

  const io::DatasetInfo info_ = io::sample_info();
  const std::vector<std::vector<Packet>> packets_{packets(0), packets(1)};
  test::TemporaryFolder temporary_;
};

TEST_F(Replay, EveryTickHasTheBytesThatWereWritten) {
  write();
  const auto run = replay_run(set());
  expect_tick(*run, 0, 0);
  EXPECT_EQ(run->status().phase, RunStatus::Phase::ready);
  EXPECT_EQ(run->info()->run_key, info_.run_key);
  EXPECT_EQ(run->info()->scenario_text, info_.scenario_text);
  for (int64_t tick = 1; tick < 70; ++tick) {
    run->step(1);
    expect_tick(*run, 0, tick);
  }
  run->step(1);
  expect_tick(*run, 1, 0);
  run->step(-1);
  expect_tick(*run, 0, 69);
}

TEST_F(Replay, JumpsShowTheNewestRecordOfEachSensor) {
  write();
  const auto run = replay_run(set());
  for (const int64_t tick : {69, 3, 33, 32, 34, 50, 49, 0, 68}) {
    run->jump(1, tick);
    expect_tick(*run, 1, tick);
    run->jump(0, tick);
    expect_tick(*run, 0, tick);
  }
  for (int64_t tick = 67; tick >= 30; --tick) {
    run->step(-1);
    expect_tick(*run, 0, tick);
  }
}

TEST_F(Replay, PlaysToTheEndAndPauses) {
  write();
  const auto run = replay_run(set());
  run->set_speed(0.0);
  run->play(true);
  ASSERT_TRUE(wait_for_pause(*run));
  expect_tick(*run, 1, 69);
}

TEST_F(Replay, AnUnfinishedDataSetShowsItsWholePackets) {
  write(40);
  const auto run = replay_run(set());
  run->set_speed(0.0);
  run->play(true);
  ASSERT_TRUE(wait_for_pause(*run));
  expect_tick(*run, 0, 39);
  run->jump(0, 60);
  expect_tick(*run, 0, 39);
  run->jump(0, 20);
  expect_tick(*run, 0, 20);
  run->jump(1, 0);
  ASSERT_TRUE(wait_for_error(*run));
  EXPECT_THAT(run->status().error, HasSubstr("sequence 1 has no tick"));
  EXPECT_TRUE(shows(*run, 0, 20));
}

TEST_F(Replay, ADamagedPictureIsNamedAndTheRestIsShown) {
  write();
  const fs::path picture = set() / "sequence_0000/uav/cam/rgb/000001.png";  // of tick 33
  fs::resize_file(picture, 100);
  const auto run = replay_run(set());
  run->set_speed(0.0);
  run->play(true);
  ASSERT_TRUE(wait_for_pause(*run));
  ASSERT_TRUE(shows(*run, 0, 33)) << "it pauses where something lacks";
  EXPECT_THAT(run->status().error, HasSubstr(picture.string()));
  EXPECT_THAT(run->status().error, HasSubstr("uav/cam"));
  EXPECT_THAT(run->status().error, HasSubstr("sequence 0, tick 33"));
  EXPECT_EQ(run->status().phase, RunStatus::Phase::ready);
  std::shared_ptr<const ShownTick> shown = run->shown();
  EXPECT_EQ(shown->newest[0], nullptr) << "not an older one in its place";
  ASSERT_EQ(shown->packet.records.size(), 1u);
  expect_same_record(packets_[0][33].records[1], shown->packet.records[0], "poses");
  expect_same_record(packets_[0][30].records[0], *shown->newest[2], "csi");
  run->step(1);
  ASSERT_TRUE(wait_until([&] { return shows(*run, 0, 34); }));
  EXPECT_THAT(run->status().error, HasSubstr("sequence 0, tick 33"))
      << "the newest picture is still that one";
  run->step(-2);
  ASSERT_TRUE(wait_until([&] { return shows(*run, 0, 32); }));
  expect_tick(*run, 0, 32);
  run->jump(0, 67);
  expect_tick(*run, 0, 67);
}

TEST_F(Replay, WithoutAStackItPausesOnceAndPlaysOn) {
  write();
  const fs::path stack = set() / "sequence_0000/bs/csi/cfr.npy";
  fs::remove(stack);
  const auto run = replay_run(set());
  ASSERT_TRUE(wait_for_error(*run));
  EXPECT_THAT(run->status().error, HasSubstr(stack.string()));
  EXPECT_THAT(run->status().error, HasSubstr("bs/csi"));
  ASSERT_TRUE(shows(*run, 0, 0));
  run->set_speed(0.0);
  run->play(true);
  ASSERT_TRUE(wait_for_pause(*run));
  expect_tick(*run, 1, 69);
}

TEST_F(Replay, AnIndexThatIsNotInOrderIsRefused) {
  write();
  const fs::path index = set() / "sequence_0001/index.npy";
  std::vector<io::IndexRow> rows = io::read_index_npy(index);
  std::swap(rows[5], rows[6]);
  io::write_file_atomically(index, io::index_npy(rows));
  const auto run = replay_run(set());
  ASSERT_TRUE(wait_for_error(*run));
  EXPECT_EQ(run->status().phase, RunStatus::Phase::failed);
  EXPECT_THAT(run->status().error, HasSubstr(index.string() + ": row 6: expected rows by ascending ticks"));
}

TEST_F(Replay, NoDataSetOrABrokenOne) {
  const auto none = replay_run(temporary_.path() / "nothing");
  ASSERT_TRUE(wait_for_error(*none));
  EXPECT_EQ(none->status().phase, RunStatus::Phase::failed);
  EXPECT_THAT(none->status().error, HasSubstr("expected a data set, found no such folder"));
  write();
  io::write_file_atomically(set() / "dataset.json", std::string("{"));
  const auto broken = replay_run(set());
  ASSERT_TRUE(wait_for_error(*broken));
  EXPECT_EQ(broken->status().phase, RunStatus::Phase::failed);
  EXPECT_THAT(broken->status().error, HasSubstr("dataset.json:1"));
}

TEST_F(Replay, WithoutSensorsOrRecordsNothingIsShown) {
  for (const bool sensors : {false, true}) {
    io::DatasetInfo info = info_;
    if (!sensors) info.sensors.clear();
    const fs::path folder = temporary_.path() / (sensors ? "no records" : "no sensors");
    {
      io::DatasetWriter writer(folder, info);
      for (uint32_t sequence = 0; sensors && sequence < info.sequences; ++sequence) {
        writer.begin_sequence(sequence);
        writer.end_sequence();
      }
      if (sensors) writer.finish();
    }
    const auto run = replay_run(folder);
    run->step(1);
    run->play(true);
    ASSERT_TRUE(wait_for_pause(*run));
    ASSERT_TRUE(wait_until([&] { return run->info() != nullptr; }));
    EXPECT_EQ(run->shown(), nullptr);
    EXPECT_EQ(run->status().error, "");
    run->jump(1, 3);
    ASSERT_TRUE(wait_for_error(*run));
    EXPECT_THAT(run->status().error, HasSubstr("sequence 1 has no tick"));
  }
}

TEST_F(Replay, TwoSideBySide) {
  write();
  const auto a = replay_run(set()), b = replay_run(set());
  for (int64_t tick = 1; tick < 40; ++tick) {
    a->step(1);
    b->jump(1, 69 - tick);
    expect_tick(*a, 0, tick);
    expect_tick(*b, 1, 69 - tick);
  }
}

TEST_F(Replay, EndsWhileItOpensReadsOrReadsAhead) {
  write();
  for (int i = 0; i < 20; ++i) {
    const auto run = replay_run(set());
    run->set_speed(0.0);
    run->play(i % 2 == 0);
    std::this_thread::sleep_for(std::chrono::microseconds(500 * i));
  }
}

size_t open_files() {
  return static_cast<size_t>(
      std::distance(fs::directory_iterator("/proc/self/fd"), fs::directory_iterator()));
}

TEST_F(Replay, ManySequencesKeepFewFilesOpen) {
  constexpr uint32_t sequences = 6;
  constexpr int stacks = 40;  // of a sequence
  io::DatasetInfo info;
  info.sequences = sequences;
  info.ticks_per_sequence = 1;
  SensorSpec sensor{"many", "pose", "1000", {}, {}, "{}"};
  for (int i = 0; i < stacks; ++i) {
    const std::string name = fmt::format("a{}", i);
    sensor.arrays.push_back({name, DType::i32, {}, "1", ""});
    sensor.outputs.push_back({name, FileFormat::npy_stack, {name}});
  }
  info.sensors = {sensor};
  const auto packet = [&](uint32_t sequence) {
    Packet made{0, 0, {{0, 0, 0, 0, {}}}};
    for (int i = 0; i < stacks; ++i)
      made.records[0].arrays.push_back(
          Array::of<int32_t>({}, std::vector{static_cast<int>(sequence) * 100 + i}));
    return made;
  };
  {
    io::DatasetWriter writer(set(), info);
    for (uint32_t sequence = 0; sequence < sequences; ++sequence) {
      writer.begin_sequence(sequence);
      writer.write(packet(sequence));
      writer.end_sequence();
    }
    writer.finish();
  }
  const size_t before = open_files();
  size_t most = 0;
  const auto run = replay_run(set());
  for (uint32_t sequence = 0; sequence < sequences; ++sequence) {
    run->jump(sequence, 0);
    ASSERT_TRUE(wait_for_tick(*run, sequence, 0));
    most = std::max(most, open_files());
    expect_shown(packet(sequence), {}, *run->shown());
  }
  EXPECT_LE(most, before + 210) << "of 240 stacks";
}

}  // namespace
}  // namespace greatx::view
