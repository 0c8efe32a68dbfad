// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Data sets that contradict their own metadata, and files that others take away. Each must end in a UserError
// that names the file.
#include <functional>
#include <sys/stat.h>
#include <unistd.h>
#include <zlib.h>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "draw/sheet/contact_sheet.h"
#include "io/dataset/dataset_reader.h"
#include "io/dataset/journal.h"
#include "io/dataset/manifest.h"
#include "io/dataset/summary.h"
#include "io/dataset/verify.h"
#include "io/files/inside.h"
#include "io/formats/npy.h"
#include "io/formats/pcd.h"
#include "tests/io/sample_run.h"
#include "tests/support/temporary_folder.h"

namespace greatx::io {
namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;
using testing::Not;

class HostileDataset : public testing::Test {
 protected:
  void SetUp() override {
    DatasetWriter writer(set(), info_);
    ASSERT_TRUE(write_sample_run(writer, info_));
  }
  fs::path set() const { return temporary_.path() / "set"; }
  fs::path cut() const { return temporary_.path() / "cut"; }
  /// Makes a data set whose writer stopped after `packets` packets.
  void leave(int64_t packets) const {
    DatasetWriter writer(cut(), info_);
    write_sample_run(writer, info_, packets);
    writer.flush();
  }
  static void replace(const fs::path& file, const std::string& what, const std::string& with) {
    std::string text = read_text_file(file);
    const size_t at = text.find(what);
    ASSERT_NE(at, text.npos) << what;
    write_file_atomically(file, text.replace(at, what.size(), with));
  }
  /// Returns the messages of verify, the reader and the contact sheet: those of UserErrors, and the problems
  /// found.
  std::string said(const fs::path& folder) const {
    std::string text;
    const auto run = [&](const std::function<void()>& action) {
      try {
        action();
      } catch (const UserError& error) {
        text += std::string(error.what()) + "\n";
      }
    };
    run([&] {
      for (const Problem& problem : verify(folder, 2)) text += problem.str() + "\n";
    });
    run([&] {
      const DatasetReader reader(folder);
      text += to_text(summarize(reader));
      contact_sheet(reader, 0);
    });
    return text;
  }
  std::string resume(const fs::path& folder) const {
    try {
      DatasetWriter writer(folder, info_, {.threads = 2, .resume = true});
      if (!writer.resume_position().finished) write_sample_run(writer, info_);
    } catch (const UserError& error) {
      return error.what();
    }
    return "resumed";
  }
  static std::string sealed(const std::string& line) {
    const auto crc =
        static_cast<uint32_t>(crc32_z(0, reinterpret_cast<const Bytef*>(line.data()), line.size()));
    return fmt::format("{}\t{:08x}\n", line, crc);
  }

  const DatasetInfo info_ = sample_info();
  test::TemporaryFolder temporary_;
};

TEST_F(HostileDataset, NumbersOfDatasetJsonAreBoundedAndNamedByLine) {
  const std::string original = read_text_file(set() / "dataset.json");
  const std::tuple<const char*, const char*, const char*> lies[] = {
      {"\"sequences\": 2", "\"sequences\": 4294967295", "sequences: expected an integer from 1 to 1000000"},
      {"\"sequences\": 2", "\"sequences\": \"two\"", "sequences: expected an integer"},
      {"\"sequences\": 2", "\"sequences\": 1e300", "sequences: expected an integer"},
      {"\"ticks_per_sequence\": 70", "\"ticks_per_sequence\": 9223372036854775807", "ticks_per_sequence: "},
      {"\"tick_rate_hz\": \"1000\"", "\"tick_rate_hz\": \"9223372036854775807\"", "tick_rate_hz: expected"},
      {"\"tick_rate_hz\": \"1000\"", "\"tick_rate_hz\": \"1/1000000000000\"", "tick_rate_hz: expected"},
      {"\"rate_hz\": \"30\"", "\"rate_hz\": \"9223372036854775807\"", "sensors[0].rate_hz: expected"},
      {"\"rate_hz\": \"30\"", "\"rate_hz\": \"30\\u001b[31m\"", "sensors[0].rate_hz: expected"},
      {"\"dtype\": \"|u1\"", "\"dtype\": \"|O\"", "sensors[0].arrays[0].dtype: expected"},
      {"\"name\": \"uav/cam\"", "\"name\": \"/etc\"", "sensor \"/etc\""},
      {"\"name\": \"uav/cam\"", "\"name\": \"../../x\"", "sensor \"../../x\""},
      {"\"name\": \"uav/cam\"", "\"name\": \"index.npy\"", "two outputs of the data set would share"},
      {"\"metadata\": {", "\"metadata\": 3, \"x\": {", "sensors[0].metadata: expected an object"},
      {"16,\n            24,", "1099511627776,\n            1099511627776,", "more than 4294967296 bytes"},
      {"\"format\": \"png\"", "\"format\": \"gif\"", "sensors[0].outputs[0].format: expected"},
  };
  for (const auto& [what, with, expected] : lies) {
    SCOPED_TRACE(with);
    write_file_atomically(set() / "dataset.json", original);
    replace(set() / "dataset.json", what, with);
    try {
      parse_dataset_json(read_text_file(set() / "dataset.json"), "dataset.json");
      FAIL() << "accepted";
    } catch (const UserError& error) {
      EXPECT_THAT(error.what(), testing::MatchesRegex("dataset\\.json:[0-9]+: .*"));
      EXPECT_THAT(error.what(), HasSubstr(expected));
      EXPECT_THAT(error.what(), Not(HasSubstr("\x1b")));
    }
    EXPECT_THAT(said(set()), HasSubstr("dataset.json"));
    EXPECT_THAT(resume(set()), HasSubstr("holds a data set of another run"));
  }
}

TEST_F(HostileDataset, DeepAndBrokenJson) {
  for (const char* file : {"dataset.json", "manifest.json"})
    for (const std::string& text : {std::string(100'000, '['), std::string("{"), std::string("7")}) {
      const std::string original = read_text_file(set() / file);
      write_file_atomically(set() / file, text);
      EXPECT_THAT(said(set()), HasSubstr(std::string(file) + ":1: ")) << text.substr(0, 9);
      write_file_atomically(set() / file, original);
    }
  write_file_atomically(set() / "dataset.json", std::string(100'000, '['));
  EXPECT_THAT(resume(set()), HasSubstr("dataset.json:1: expected JSON nested at most 64 deep"));
}

TEST_F(HostileDataset, PathsOfTheManifestStayInside) {
  const std::string original = read_text_file(set() / "manifest.json");
  for (const char* path : {"/etc/passwd", "../outside", "sequence_0000/../../outside", "a//b", ""}) {
    write_file_atomically(set() / "manifest.json", original);
    replace(set() / "manifest.json", "{\"path\": \"dataset.json\"", fmt::format("{{\"path\": \"{}\"", path));
    EXPECT_THAT(said(set()), HasSubstr("manifest.json:6: files[0].path: expected a path below")) << path;
  }
  write_file_atomically(set() / "manifest.json", original);
  replace(set() / "manifest.json", "\"size\": ", "\"size\": -");
  EXPECT_THAT(said(set()), HasSubstr("files[0].size: expected an integer from 0"));
}

TEST_F(HostileDataset, LinksAndFifosAreRefused) {
  const fs::path outside = temporary_.path() / "outside";
  for (const char* name : {"dataset.json", "scenario.yaml", "manifest.json", "sequence_0000/index.npy",
                           "sequence_0000/uav/cam/rgb/000000.png", "sequence_0000/bs/csi/cfr.npy"}) {
    SCOPED_TRACE(name);
    const fs::path file = set() / name;
    fs::rename(file, outside);
    fs::create_symlink(outside, file);
    EXPECT_THAT(said(set()),
                HasSubstr(file.string() + ": expected no symbolic link in a data set, found one"));
    fs::remove(file);
    ASSERT_EQ(::mkfifo(file.c_str(), 0600), 0);
    EXPECT_THAT(said(set()), HasSubstr(file.string() + ": expected a file, found a FIFO"));
    fs::remove(file);
    fs::create_directory(file);
    EXPECT_THAT(said(set()), HasSubstr(file.string() + ": expected a file, found a folder"));
    fs::remove(file);
    fs::rename(outside, file);
  }
  fs::rename(set() / "sequence_0000", outside);
  fs::create_directory_symlink(outside, set() / "sequence_0000");
  EXPECT_THAT(said(set()), HasSubstr("sequence_0000: expected no symbolic link"));
}

TEST_F(HostileDataset, ResumeWritesThroughNoLink) {
  const fs::path outside = temporary_.path() / "outside";
  const std::string precious(1 << 20, 'x');
  for (const char* name :
       {"journal.txt", "scenario.yaml", "scenario.yaml.part", "sequence_0000/bs/csi/cfr.npy.part",
        "sequence_0000/bs/csi/delay_offsets.npy.part", "sequence_0000/index.npy.part",
        "sequence_0000/uav/cam/rgb/000002.png.part", "manifest.json.part"}) {
    SCOPED_TRACE(name);
    leave(40);
    write_file_atomically(outside, precious);
    fs::remove(cut() / name);
    fs::create_symlink(outside, cut() / name);
    EXPECT_THAT(resume(cut()), HasSubstr("symbolic link"));
    EXPECT_EQ(read_text_file(outside), precious);
    fs::remove_all(cut());
  }
  leave(40);
  fs::create_directory(temporary_.path() / "folder");
  fs::create_directory_symlink(temporary_.path() / "folder", cut() / "sequence_0001");
  EXPECT_THAT(resume(cut()), HasSubstr("symbolic link"));
  EXPECT_TRUE(fs::is_empty(temporary_.path() / "folder"));
}

TEST_F(HostileDataset, JournalsThatLie) {
  leave(40);
  const std::string original = read_text_file(cut() / "journal.txt");
  const std::string hash(64, 'a');
  const std::pair<std::string, const char*> lies[] = {
      {R"({"packet":[4294967295,40,40000000],"records":[],"files":[]})", "packet[0]: expected an integer"},
      {R"({"packet":[999999,40,40000000],"records":[],"files":[]})", "expected sequence 0, found 999999"},
      {R"({"packet":[0,3,3000000],"records":[],"files":[]})", "expected a tick from here on: 40, found 3"},
      {R"({"packet":[0,70,70000000],"records":[],"files":[]})", "expected a tick below 70, found 70"},
      {R"({"packet":[0,40,40000000],"records":[[5,1]],"files":[]})", "expected a sensor below 5, found 5"},
      {R"({"packet":[0,40,40000000],"records":[[0,1]],"files":[]})", "as its records have: 5, found 0"},
      {R"({"packet":[0,40],"records":[],"files":[]})", "packet: expected a list of 3"},
      {R"({"packet":7})", "packet: expected a list of 3"},
      {R"({"records":[]})", "packet: expected a value, found none"},
      {R"({"end":1,"files":[]})", "expected the end of sequence 0, found 1"},
      {R"({"end":0,"files":[["/etc/passwd",1,")" + hash + "\"]]}", "files[0][0]: expected a path below"},
      {R"({"end":0,"files":[["x",1,"ff"]]})", "files[0][2]: expected a SHA-256"},
      {"[" + std::string(1000, '['), "nested at most 64 deep"},
      {"no JSON", "is no JSON"},
  };
  for (const auto& [line, expected] : lies) {
    SCOPED_TRACE(line.substr(0, 80));
    write_file_atomically(cut() / "journal.txt", original + sealed(line));
    EXPECT_THAT(said(cut()), HasSubstr("journal.txt:41: "));
    EXPECT_THAT(said(cut()), HasSubstr(expected));
    EXPECT_THAT(resume(cut()), HasSubstr(expected));
  }
}

TEST_F(HostileDataset, RowsOfTheIndexAreBounded) {
  const std::vector<IndexRow> good = read_index_npy(set() / "sequence_0000/index.npy");
  const std::pair<IndexRow, const char*> lies[] = {
      {{INT64_MAX, 0, 0, 0, 0}, "row 3: expected a tick from 0 to 69"},
      {{0, INT64_MIN, 0, 0, 0}, "row 3: expected a time in ns"},
      {{0, 0, 5, 0, 0}, "row 3: expected a sensor from 0 to 4, found 5"},
      {{0, 0, -1, 0, 0}, "row 3: expected a sensor"},
      {{0, 0, 0, INT64_MAX, 0}, "row 3: expected a sample"},
      {{0, 0, 0, 0, -1}, "row 3: expected a row"},
  };
  for (const auto& [row, expected] : lies) {
    std::vector<IndexRow> rows = good;
    rows[3] = row;
    write_file_atomically(set() / "sequence_0000/index.npy", index_npy(rows));
    EXPECT_THAT(said(set()), HasSubstr(expected));
  }
}

TEST_F(HostileDataset, MetadataAndArraysThatPanelsCannotDraw) {
  const std::string original = read_text_file(set() / "dataset.json");
  const std::tuple<const char*, const char*, const char*> lies[] = {
      {"\"subcarrier_spacing_hz\": 30000.0", "\"subcarrier_spacing_hz\": \"x\"",
       "bs/csi: metadata: subcarrier_spacing_hz: expected a number"},
      {"\"nodes\": [", "\"nodes\": [7,", "poses: metadata: nodes[0]: expected a string"},
      {"\"fx\": 20.0", "\"body_from_sensor\": {\"position_m\": [1]}", ""},
      {"\"kind\": \"lidar\"", "\"kind\": \"camera\"", ""},
      {"\"kind\": \"csi\"", "\"kind\": \"lidar\"", ""},
      {"\"kind\": \"camera\"", "\"kind\": \"radar\"", ""},
  };
  for (const auto& [what, with, expected] : lies) {
    SCOPED_TRACE(with);
    write_file_atomically(set() / "dataset.json", original);
    replace(set() / "dataset.json", what, with);
    EXPECT_THAT(said(set()), HasSubstr(expected));
  }
}

TEST_F(HostileDataset, ASparseOrShortArrayAsksForNoMemory) {
  for (const char* name :
       {"sequence_0000/index.npy", "sequence_0000/index.csv", "manifest.json", "dataset.json",
        "sequence_0000/uav/cam/rgb/000000.png", "sequence_0000/uav/lidar/pcd/000000.pcd",
        "sequence_0000/bs/csi/loss/000000.npy"}) {
    SCOPED_TRACE(name);
    const std::string original = read_text_file(set() / name);
    fs::resize_file(set() / name, uint64_t{100} << 30);
    EXPECT_THAT(said(set()), HasSubstr(name));
    write_file_atomically(set() / name, original);
  }
}

TEST_F(HostileDataset, ADeletedOrShortenedFileIsNoticedByTheWriter) {
  for (const bool remove : {true, false})
    for (const char* name :
         {"journal.txt", "sequence_0000/bs/csi/cfr.npy.part", "sequence_0000/bs/csi/delay.npy.part",
          "sequence_0000/uav/cam/rgb/000000.png", "sequence_0000/uav/lidar/velodyne/000000.bin"}) {
      SCOPED_TRACE(name);
      std::string message = "no error";
      try {
        DatasetWriter writer(cut(), info_);
        write_sample_run(writer, info_, 40);
        writer.flush();
        if (remove)
          fs::remove(cut() / name);
        else
          fs::resize_file(cut() / name, 1);
        for (int64_t tick = 40; tick < info_.ticks_per_sequence; ++tick)
          writer.write(sample_packet(info_, 0, tick));
        writer.end_sequence();
      } catch (const UserError& error) {
        message = error.what();
      }
      EXPECT_THAT(message, HasSubstr((cut() / name).string()));
      EXPECT_THAT(message, HasSubstr(remove ? "was deleted while" : "it was changed while"));
      fs::remove_all(cut());
    }
}

TEST_F(HostileDataset, AFileOfAClosedSequenceIsMissedWhenTheDataSetEnds) {
  for (const char* name :
       {"sequence_0000/bs/csi/cfr.npy", "sequence_0000/uav/cam/depth/000001.exr", "scenario.yaml"}) {
    std::string message = "no error";
    try {
      DatasetWriter writer(cut(), info_);
      write_sample_run(writer, info_, 100);
      writer.flush();
      fs::remove(cut() / name);
      for (int64_t tick = 30; tick < info_.ticks_per_sequence; ++tick)
        writer.write(sample_packet(info_, 1, tick));
      writer.end_sequence();
      writer.finish();
    } catch (const UserError& error) {
      message = error.what();
    }
    EXPECT_EQ(message, (cut() / name).string() + ": was deleted while the data set was being written");
    EXPECT_FALSE(fs::exists(cut() / "manifest.json"));
    fs::remove_all(cut());
  }
}

TEST(HostileFiles, APcdWithoutFields) {
  const Array points(DType::f32, {2, 4});
  const Bytes file = encode_pcd({"points"}, {&points});
  std::string text(reinterpret_cast<const char*>(file.data()), file.size());
  for (const char* key : {"FIELDS", "SIZE", "TYPE", "COUNT"}) {
    const size_t begin = text.find(std::string("\n") + key) + 1;
    text.replace(begin, text.find('\n', begin) - begin, key);
  }
  EXPECT_THROW(decode_pcd(bytes_of(text), "x.pcd"), UserError);
}

TEST(HostileFiles, AnNpyOfRowsThatOverflow) {
  const test::TemporaryFolder folder;
  for (const std::vector<int64_t>& shape : {std::vector<int64_t>{0, int64_t{1} << 40, int64_t{1} << 40},
                                            {int64_t{1} << 62, 4},
                                            {INT64_MAX, INT64_MAX}}) {
    write_file_atomically(folder.path() / "x.npy", npy_header(DType::f64, shape));
    EXPECT_THROW(NpyFile(folder.path() / "x.npy"), UserError);
  }
}

TEST(HostileFiles, TheWayInside) {
  const test::TemporaryFolder folder;
  write_file_atomically(folder.path() / "file", std::string_view("x"));
  EXPECT_EQ(size_inside(folder.path(), "file"), 1u);
  EXPECT_EQ(size_inside(folder.path(), "none/at/all"), std::nullopt);
  for (const char* path : {"", "/", "..", "a/../b", "./a", "a/", "a\nb", "a\\b"})
    EXPECT_THROW(inside(folder.path(), path), UserError) << path;
  EXPECT_THROW(inside(folder.path(), "file/below"), UserError);
  EXPECT_THROW(create_folders_inside(folder.path(), "file/below"), UserError);
  fs::create_directory_symlink("/", folder.path() / "link");
  EXPECT_THROW(inside(folder.path(), "link/tmp"), UserError);
  EXPECT_THROW(create_folders_inside(folder.path(), "link/tmp/x"), UserError);
  EXPECT_THROW(File::open_for_writing(folder.path() / "link"), UserError);
}

TEST(HostileFiles, RatesAndTicksGiveExactNumbersWithoutLoops) {
  const SampleClock extreme("1/1000000000000", "1000000000000");
  EXPECT_THROW(extreme.samples_before(most_ticks), UserError);  // 10^36 samples
  EXPECT_THROW(extreme.time_ns(most_ticks), UserError);
  for (const char* rate :
       {"9223372036854775807", "1/9223372036854775807", "1000000000001", "1/0", "0", "-1", "1e9"})
    EXPECT_THROW(SampleClock("1", rate), UserError) << rate;
  for (const char* rate : {"30", "29.97", "30000/1001", "1/7", "1000", "0.3"}) {
    const SampleClock clock("1000", rate);
    for (const int64_t tick : {0, 1, 33, 34, 999, 1000, 12345}) {
      const int64_t count = clock.samples_before(tick);
      EXPECT_TRUE(count == 0 || clock.tick_of(count - 1) < tick) << rate << ' ' << tick;
      EXPECT_GE(clock.tick_of(count), tick) << rate << ' ' << tick;
    }
  }
}

}  // namespace
}  // namespace greatx::io
