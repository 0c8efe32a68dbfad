// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include <atomic>
#include <functional>
#include <limits>
#include <thread>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "io/dataset/dataset_reader.h"
#include "io/dataset/verify.h"
#include "tests/io/sample_run.h"
#include "tests/support/temporary_folder.h"

namespace greatx::io {
namespace {

using testing::HasSubstr;

std::string message_of(const std::function<void()>& action) {
  try {
    action();
  } catch (const UserError& error) {
    return error.what();
  }
  return "(no UserError)";
}

std::string problems_of(const std::filesystem::path& folder) {
  std::string text;
  for (const Problem& problem : verify(folder, 2)) text += problem.str() + "\n";
  return text;
}

void write_whole_run(const std::filesystem::path& folder, uint32_t threads = 2) {
  const DatasetInfo info = sample_info();
  DatasetWriter writer(folder, info, {.threads = threads});
  ASSERT_TRUE(write_sample_run(writer, info));
}

TEST(Dataset, WhatIsWrittenIsReadBack) {
  const test::TemporaryFolder folder;
  write_whole_run(folder.path() / "set");
  const DatasetReader reader(folder.path() / "set");
  EXPECT_TRUE(reader.finished());
  EXPECT_EQ(dataset_json(reader.info()), dataset_json(sample_info()));
  ASSERT_EQ(reader.sequences(), 2u);
  const DatasetInfo info = sample_info();
  for (uint32_t sequence = 0; sequence < 2; ++sequence) {
    size_t records = 0;
    for (const IndexRow& row : reader.records(sequence)) {
      const Packet packet = sample_packet(info, sequence, row.tick);
      const auto record = std::find_if(packet.records.begin(), packet.records.end(),
                                       [&](const Record& r) { return r.sensor == row.sensor; });
      ASSERT_NE(record, packet.records.end());
      EXPECT_EQ(record->sample, row.sample);
      EXPECT_EQ(record->time_ns, row.time_ns);
      const SensorSpec& sensor = info.sensors[record->sensor];
      for (size_t a = 0; a < sensor.arrays.size(); ++a) {
        const Array array = reader.load(sequence, row, sensor.arrays[a].name);
        EXPECT_EQ(array.shape, record->arrays[a].shape) << sensor.arrays[a].name;
        EXPECT_EQ(array.bytes, record->arrays[a].bytes) << sensor.arrays[a].name;
      }
      ++records;
    }
    // 30 Hz: ticks 0, 33, 67. 20 Hz: ticks 0, 50. 100 Hz: 7 records. 1 kHz: 70 records.
    EXPECT_EQ(records, 3u + 2u + 7u + 70u + 4u);
  }
}

TEST(Dataset, VerifiesAndLeavesNothingBehind) {
  const test::TemporaryFolder folder;
  write_whole_run(folder.path());
  EXPECT_EQ(problems_of(folder.path()), "");
  for (const auto& [path, text] : contents(folder.path())) {
    EXPECT_FALSE(path.ends_with(".part")) << path;
    EXPECT_NE(path, "journal.txt");
  }
}

TEST(Dataset, FollowsTheDocumentedLayout) {
  const test::TemporaryFolder folder;
  write_whole_run(folder.path());
  const auto files = contents(folder.path());
  for (const char* path : {"manifest.json", "dataset.json", "scenario.yaml", "sequence_0000/index.csv",
                           "sequence_0001/index.npy", "sequence_0000/uav/cam/rgb/000002.png",
                           "sequence_0000/uav/cam/depth/000000.exr",
                           "sequence_0000/uav/lidar/cloud/000001.ply", "sequence_0000/bs/csi/cfr.npy",
                           "sequence_0000/bs/csi/delay_offsets.npy", "sequence_0000/poses/position.npy"})
    EXPECT_TRUE(files.contains(path)) << path;
  EXPECT_THAT(files.at("sequence_0000/index.csv"),
              HasSubstr("tick,time_ns,sensor,sample,row,name\n0,0,0,0,0,uav/cam\n0,0,1,0,0,uav/lidar\n"));
  EXPECT_THAT(files.at("sequence_0000/index.csv"), HasSubstr("\n33,33000000,0,1,1,uav/cam\n"));
}

TEST(Dataset, ThreadsDoNotChangeAByte) {
  const test::TemporaryFolder folder;
  for (const uint32_t threads : {1, 2, 4}) write_whole_run(folder.path() / std::to_string(threads), threads);
  const auto one = contents(folder.path() / "1");
  EXPECT_EQ(contents(folder.path() / "2"), one);
  EXPECT_EQ(contents(folder.path() / "4"), one);
}

TEST(Dataset, ASmallQueueIsOnlySlower) {
  const test::TemporaryFolder folder;
  const DatasetInfo info = sample_info();
  DatasetWriter writer(folder.path(), info, {.threads = 3, .queue_packets = 1});
  EXPECT_TRUE(write_sample_run(writer, info));
  EXPECT_EQ(writer.stats().packets, 2 * 70);
  EXPECT_EQ(problems_of(folder.path()), "");
}

TEST(Dataset, AFolderWithOtherFilesIsLeftAlone) {
  const test::TemporaryFolder folder;
  write_file_atomically(folder.path() / "thesis.txt", std::string_view("years of work"));
  for (const bool resume : {false, true}) {
    EXPECT_THAT(message_of([&] { DatasetWriter(folder.path(), sample_info(), {.resume = resume}); }),
                HasSubstr("thesis.txt"));
  }
  EXPECT_EQ(contents(folder.path()).size(), 1u);
}

TEST(Dataset, AFinishedSetIsNotOverwritten) {
  const test::TemporaryFolder folder;
  write_whole_run(folder.path());
  const auto before = contents(folder.path());
  EXPECT_THAT(message_of([&] { DatasetWriter(folder.path(), sample_info()); }),
              HasSubstr("finished data set"));
  DatasetWriter again(folder.path(), sample_info(), {.resume = true});
  EXPECT_TRUE(again.resume_position().finished);
  EXPECT_EQ(again.resume_position().sequence, 2u);
  again.finish();
  EXPECT_EQ(contents(folder.path()), before);
}

TEST(Dataset, AnotherRunIsNotResumed) {
  const test::TemporaryFolder folder;
  {
    DatasetWriter writer(folder.path(), sample_info());
    EXPECT_FALSE(write_sample_run(writer, sample_info(), 20));
  }
  EXPECT_THAT(message_of([&] { DatasetWriter(folder.path(), sample_info()); }),
              HasSubstr("--resume finishes it"));
  DatasetInfo other = sample_info();
  other.run_json = R"({"scenario": "sample", "seed": 8, "scene_sha256": "00ff"})";
  other.sensors[0].rate = "25";
  const std::string message = message_of([&] { DatasetWriter(folder.path(), other, {.resume = true}); });
  EXPECT_THAT(message, HasSubstr("run/seed: the data set has 7, this run has 8"));
  EXPECT_THAT(message, HasSubstr("sensors/0/rate_hz: the data set has \"30\", this run has \"25\""));
}

TEST(Dataset, TwoWritersDoNotMeet) {
  const test::TemporaryFolder folder;
  DatasetWriter first(folder.path(), sample_info());
  EXPECT_THAT(message_of([&] { DatasetWriter(folder.path(), sample_info(), {.resume = true}); }),
              HasSubstr("another process"));
}

TEST(Dataset, AnUnwritablePlaceIsNamed) {
  const test::TemporaryFolder folder;
  write_file_atomically(folder.path() / "file", std::string_view("x"));
  const std::string message =
      message_of([&] { DatasetWriter(folder.path() / "file" / "set", sample_info()); });
  EXPECT_THAT(message, HasSubstr("file/set"));
  EXPECT_THAT(message, HasSubstr("Not a directory"));
  EXPECT_THAT(message_of([&] { DatasetWriter(folder.path() / "file", sample_info()); }),
              HasSubstr("cannot be written"));
}

TEST(Dataset, SensorNamesStayInsideTheFolder) {
  const test::TemporaryFolder folder;
  for (const char* name : {"../evil", "/etc", "a//b", "", "a/./b", "tab\t"}) {
    DatasetInfo info = sample_info();
    info.sensors[0].name = name;
    EXPECT_THAT(message_of([&] { DatasetWriter(folder.path() / "set", info); }), HasSubstr("sensor")) << name;
  }
  DatasetInfo twice = sample_info();
  twice.sensors.push_back(twice.sensors[0]);
  EXPECT_THAT(message_of([&] { DatasetWriter(folder.path() / "set", twice); }), HasSubstr("share"));
}

TEST(Dataset, ARecordMustBeWhatWasDeclared) {
  const test::TemporaryFolder folder;
  const DatasetInfo info = sample_info();
  DatasetWriter writer(folder.path(), info);
  writer.begin_sequence(0);
  Packet wrong = sample_packet(info, 0, 0);
  wrong.records[0].arrays[0] = Array(DType::u8, {8, 8, 3});
  EXPECT_THROW(writer.write(wrong), ContractError);
  wrong = sample_packet(info, 0, 0);
  wrong.records[1].time_ns = 1;
  EXPECT_THROW(writer.write(wrong), ContractError);
  wrong = sample_packet(info, 0, 0);
  std::swap(wrong.records[0], wrong.records[1]);
  EXPECT_THROW(writer.write(wrong), ContractError);
  writer.write(sample_packet(info, 0, 0));
  EXPECT_THROW(writer.write(sample_packet(info, 0, 0)), ContractError);
}

TEST(Dataset, ANanFailsTheRunByName) {
  const test::TemporaryFolder folder;
  const DatasetInfo info = sample_info();
  DatasetWriter writer(folder.path(), info);
  writer.begin_sequence(0);
  writer.write(sample_packet(info, 0, 0));
  Packet bad = sample_packet(info, 0, 10);
  bad.records[0].arrays[0].as<std::complex<float>>()[5] = {0.0f, std::numeric_limits<float>::quiet_NaN()};
  writer.write(bad);
  try {
    writer.end_sequence();
    FAIL() << "no error";
  } catch (const ContractError& error) {
    EXPECT_THAT(error.what(), HasSubstr("bs/csi, tick 10, sample 1: nan at element 5 of cfr"));
  }
  EXPECT_THROW(writer.write(sample_packet(info, 0, 11)), ContractError) << "the error stays";
  EXPECT_EQ(DatasetReader(folder.path()).records(0).size(), 5u) << "only the packet before it";
}

TEST(Dataset, ManyThreadsLoadPackedRecords) {
  const test::TemporaryFolder folder;
  const DatasetInfo info = sample_info();
  DatasetWriter writer(folder.path(), info);
  ASSERT_TRUE(write_sample_run(writer, info));
  const DatasetReader reader(folder.path());
  const SensorSpec& sensor = info.sensors[4];
  std::atomic<int> wrong = 0;
  std::vector<std::thread> threads;
  for (int thread = 0; thread < 8; ++thread) {
    threads.emplace_back([&] {
      for (uint32_t sequence = 0; sequence < 2; ++sequence) {
        for (const IndexRow& row : reader.records_of(sequence, 4)) {
          const Packet packet = sample_packet(info, sequence, row.tick);
          for (size_t a = 0; a < sensor.arrays.size(); ++a)
            wrong += reader.load(sequence, row, sensor.arrays[a].name).bytes !=
                     packet.records.back().arrays[a].bytes;
        }
      }
    });
  }
  for (std::thread& thread : threads) thread.join();
  EXPECT_EQ(wrong, 0);
}

TEST(Dataset, OnlyACamerasDepthMayBeInfinite) {
  const DatasetInfo info = sample_info();
  constexpr float infinity = std::numeric_limits<float>::infinity();
  const auto check = [&](const SensorSpec& sensor, const std::string& name, float value) {
    Array array(DType::f32, {3});
    array.as<float>()[1] = value;
    return find_bad_value(sensor, {name, DType::f32, {3}, "", ""}, array);
  };
  EXPECT_EQ(check(info.sensors[0], "depth", infinity), "");
  EXPECT_EQ(check(info.sensors[0], "depth_log", infinity), "");
  EXPECT_EQ(check(info.sensors[0], "depth", -infinity), "-inf at element 1 of depth");
  EXPECT_EQ(check(info.sensors[0], "depth", std::numeric_limits<float>::quiet_NaN()),
            "nan at element 1 of depth");
  EXPECT_EQ(check(info.sensors[0], "radiance", infinity), "inf at element 1 of radiance");
  EXPECT_EQ(check(info.sensors[1], "depth", infinity), "inf at element 1 of depth");
  SensorSpec padded = info.sensors[2];
  padded.metadata_json = R"({"non_finite": ["power"]})";
  EXPECT_EQ(check(padded, "power", -infinity), "");
  EXPECT_EQ(check(padded, "phase", -infinity), "-inf at element 1 of phase");
}

TEST(SampleClock, FiresAtRoundedTicks) {
  const SampleClock camera("1000", "30");
  const std::vector<int64_t> expected{0, 33, 67, 100};
  for (int64_t k = 0; k < 4; ++k) EXPECT_EQ(camera.tick_of(k), expected[static_cast<size_t>(k)]);
  EXPECT_EQ(camera.tick_of(108000), 3600000);
  EXPECT_EQ(camera.samples_before(3600000), 108000);
  EXPECT_EQ(camera.samples_before(34), 2);
  EXPECT_EQ(camera.samples_before(33), 1);
  EXPECT_EQ(SampleClock("1000", "400").tick_of(1), 3) << "2.5 rounds up";
  EXPECT_EQ(SampleClock("1000", "29.97").tick_of(2997), 100000);
  EXPECT_EQ(SampleClock("30000/1001", "30000/1001").time_ns(30000), 1001000000000);
  EXPECT_EQ(SampleClock("3", "1").time_ns(2), 666666667);
  for (const char* bad : {"", "0", "-1", "1/0", "x", "30Hz", "1e3"})
    EXPECT_THROW(SampleClock("1000", bad), UserError) << bad;
}

}  // namespace
}  // namespace greatx::io
