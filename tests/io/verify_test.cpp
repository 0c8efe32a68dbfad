// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Every kind of damage must be found and named. For damage that the hashes would find first, the tests
// correct the manifest, so that the check behind the hashes is tested.
#include "io/dataset/verify.h"

#include <cstring>
#include <functional>
#include <limits>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/hash.h"
#include "io/formats/exr.h"
#include "io/formats/npy.h"
#include "io/formats/packed_columns.h"
#include "io/formats/ply.h"
#include "tests/io/sample_run.h"
#include "tests/support/temporary_folder.h"

namespace greatx::io {
namespace {

using testing::HasSubstr;

class Verify : public testing::Test {
 protected:
  void SetUp() override {
    DatasetWriter writer(folder(), info_);
    ASSERT_TRUE(write_sample_run(writer, info_));
    ASSERT_EQ(problems(), "");
  }
  std::filesystem::path folder() const { return temporary_.path() / "set"; }
  std::string problems() const {
    std::string text;
    for (const Problem& problem : verify(folder(), 2)) text += problem.str() + "\n";
    return text;
  }
  void flip_byte(const std::string& path, size_t at) const {
    Bytes bytes = read_file(folder() / path);
    bytes.at(at) ^= std::byte{1};
    write_file_atomically(folder() / path, bytes);
  }
  /// Replaces a file and corrects the manifest to match.
  void forge(const std::string& path, std::span<const std::byte> bytes) const {
    const Bytes old = read_file(folder() / path);
    write_file_atomically(folder() / path, bytes);
    std::string manifest = read_text_file(folder() / "manifest.json");
    const auto entry = [&](std::span<const std::byte> content) {
      return fmt::format("\"path\": \"{}\", \"size\": {}, \"sha256\": \"{}\"", path, content.size(),
                         sha256_hex(content));
    };
    const size_t at = manifest.find(entry(old));
    ASSERT_NE(at, manifest.npos) << path;
    manifest.replace(at, entry(old).size(), entry(bytes));
    write_file_atomically(folder() / "manifest.json", manifest);
  }
  void forge_index(const std::function<void(std::vector<IndexRow>&)>& change) const {
    std::vector<IndexRow> rows = read_index_npy(folder() / "sequence_0000/index.npy");
    change(rows);
    const std::string csv = index_csv(info_, rows);
    forge("sequence_0000/index.npy", index_npy(rows));
    forge("sequence_0000/index.csv", bytes_of(csv));
  }

  const DatasetInfo info_ = sample_info();
  test::TemporaryFolder temporary_;
};

TEST_F(Verify, AFlippedByteInAnyFile) {
  for (const auto& [path, text] : contents(folder())) {
    if (path == "manifest.json" || text.empty()) continue;
    flip_byte(path, text.size() / 2);
    EXPECT_THAT(problems(), HasSubstr(path + ": has another SHA-256")) << path;
    flip_byte(path, text.size() / 2);
  }
  EXPECT_EQ(problems(), "");
}

TEST_F(Verify, AMissingFile) {
  std::filesystem::remove(folder() / "sequence_0001/uav/cam/rgb/000001.png");
  EXPECT_THAT(problems(), HasSubstr("sequence_0001/uav/cam/rgb/000001.png: is missing"));
}

TEST_F(Verify, AMissingIndexOrScenario) {
  std::filesystem::remove(folder() / "sequence_0001/index.npy");
  EXPECT_THAT(problems(), HasSubstr("sequence_0001/index.npy: is missing"));
  std::filesystem::remove(folder() / "scenario.yaml");
  EXPECT_THAT(problems(), HasSubstr("scenario.yaml: is missing"));
}

TEST_F(Verify, AnExtraFile) {
  write_file_atomically(folder() / "sequence_0000/uav/cam/rgb/000003.png", std::string_view("x"));
  write_file_atomically(folder() / "contact_sheet.png", std::string_view("x"));  // a known extra file
  EXPECT_EQ(
      problems(),
      "sequence_0000/uav/cam/rgb/000003.png: does not belong to the data set: expected no such file, found a "
      "file\n");
}

TEST_F(Verify, ATruncatedFile) {
  const std::filesystem::path file = folder() / "sequence_0000/bs/csi/cfr.npy";
  const uint64_t size = std::filesystem::file_size(file);
  std::filesystem::resize_file(file, size - 8);
  EXPECT_EQ(problems(),
            fmt::format("sequence_0000/bs/csi/cfr.npy: has another size: expected {} bytes, found {} "
                        "bytes\n",
                        size, size - 8));
}

TEST_F(Verify, ABrokenManifest) {
  write_file_atomically(folder() / "manifest.json", std::string_view("{"));
  EXPECT_THAT(problems(), HasSubstr("manifest.json"));
}

TEST_F(Verify, AnUnfinishedSet) {
  std::filesystem::remove(folder() / "manifest.json");
  EXPECT_THAT(problems(), HasSubstr("unfinished"));
  EXPECT_THROW(verify(temporary_.path()), UserError);
}

TEST_F(Verify, AGapInTheSamples) {
  forge_index([](std::vector<IndexRow>& rows) { rows.erase(rows.begin() + 20); });
  EXPECT_THAT(problems(), HasSubstr("poses: number of records: expected 70, found 69"));
}

TEST_F(Verify, ATickThatDoesNotFitTheRate) {
  forge_index([](std::vector<IndexRow>& rows) {
    for (IndexRow& row : rows)
      if (row.sensor == 0 && row.sample == 1) row.tick = 34, row.time_ns = 34'000'000;
  });
  EXPECT_THAT(problems(), HasSubstr("uav/cam, tick 34: tick of the sample: expected 33, found 34"));
}

TEST_F(Verify, ATimeThatDoesNotFitTheTick) {
  forge_index([](std::vector<IndexRow>& rows) { rows.back().time_ns += 1; });
  EXPECT_THAT(problems(), HasSubstr("poses, tick 69: time in ns: expected 69000000, found 69000001"));
}

TEST_F(Verify, AStackOfAnotherLength) {
  const NpyFile file(folder() / "sequence_0000/poses/position.npy");
  forge("sequence_0000/poses/position.npy", encode_npy(file.read_rows(0, 69)));
  EXPECT_THAT(problems(), HasSubstr("position.npy: shape: expected <f8 [70, 2, 3], found <f8 [69, 2, 3]"));
}

TEST_F(Verify, RaggedOffsetsThatDoNotFit) {
  Array offsets = NpyFile(folder() / "sequence_0000/bs/csi/delay_offsets.npy").read();
  offsets.as<int64_t>().back() += 1;
  forge("sequence_0000/bs/csi/delay_offsets.npy", encode_npy(offsets));
  EXPECT_THAT(problems(), HasSubstr("delay.npy: shape"));
  offsets.as<int64_t>()[1] = 99;
  forge("sequence_0000/bs/csi/delay_offsets.npy", encode_npy(offsets));
  EXPECT_THAT(problems(), HasSubstr("delay_offsets.npy: offsets do not ascend from 0"));
}

TEST_F(Verify, NanInAStackAFrameAndACloud) {
  constexpr float nan = std::numeric_limits<float>::quiet_NaN();
  Array cfr = NpyFile(folder() / "sequence_0000/bs/csi/cfr.npy").read();
  cfr.as<std::complex<float>>()[100] = {nan, 0.0f};
  forge("sequence_0000/bs/csi/cfr.npy", encode_npy(cfr));
  Array depth = read_exr(folder() / "sequence_0000/uav/cam/depth/000000.exr");
  depth.as<float>()[50] = nan;
  forge("sequence_0000/uav/cam/depth/000000.exr", encode_exr(depth));
  const std::vector<float> point{1, nan, 3, 4};
  const Array points = Array::of<float>({1, 4}, point), ring(DType::u16, {1}), time(DType::f32, {1});
  forge("sequence_0001/uav/lidar/cloud/000000.ply",
        encode_ply({"points", "ring", "time"}, {&points, &ring, &time}));
  const std::string text = problems();
  EXPECT_THAT(text, HasSubstr("cfr.npy: from row 0 on: expected finite values, found nan at element 100"));
  EXPECT_THAT(text, HasSubstr("depth/000000.exr: values: expected finite values, found nan at element 50"));
  EXPECT_THAT(text, HasSubstr("cloud/000000.ply: values: expected finite values, found nan at element 1"));
}

TEST_F(Verify, PackedRecordsWhosePlacesLie) {
  const std::string table = "sequence_0000/uav/packed/records.npy",
                    data = "sequence_0000/uav/packed/records.h5";
  const Array good = NpyFile(folder() / table).read();
  const int64_t columns = good.shape[1];
  const auto problems_with = [&](int64_t column, size_t number, int64_t value) {
    Array bad = good;
    // Record 2 has no empty column, so that every number of a place matters.
    bad.as<int64_t>()[static_cast<size_t>((2 * columns + column) * 5) + number] = value;
    forge(table, encode_npy(bad));
    return problems();
  };
  const std::string place = "records.npy: record 2: ";
  EXPECT_THAT(problems_with(0, 0, -1), HasSubstr(place + "t_steps: expected packed bytes within the"));
  EXPECT_THAT(problems_with(0, 1, int64_t{1} << 62),
              HasSubstr(place + "t_steps: expected packed bytes within"));
  EXPECT_THAT(problems_with(1, 2, int64_t{1} << 31), HasSubstr(place + "x: expected"));
  EXPECT_THAT(problems_with(3, 3, 3), HasSubstr(place + "p: expected a type that the column may have"));
  EXPECT_THAT(problems_with(8, 2, 2), HasSubstr(place + "map: expected 1 row, found 2"));
  EXPECT_THAT(problems_with(4, 0, 0), HasSubstr("records.h5: record 2: points/x: expected"));
  EXPECT_THAT(problems_with(5, 2, 1), HasSubstr("record 2: "));
  forge(table, encode_npy(good));
  EXPECT_EQ(problems(), "");
  forge(table, encode_npy(Array(DType::i64, {good.shape[0] + 1, columns, 5})));
  EXPECT_THAT(problems(), HasSubstr("records.npy: number of records: expected 4, found 5"));
  forge(table, encode_npy(Array(DType::i64, {good.shape[0], 5, columns})));
  EXPECT_THAT(problems(), HasSubstr("records.npy: expected <i8 [records, 9, 5] as greatx writes it"));
  forge(table, encode_npy(good));
  Bytes cut = read_file(folder() / data);
  cut.resize(cut.size() / 2);
  forge(data, cut);
  EXPECT_THAT(problems(), HasSubstr("packed bytes within the"));
}

TEST_F(Verify, NanInPackedRecords) {
  const SensorSpec& sensor = info_.sensors[4];
  const OutputSpec& output = sensor.outputs[0];
  std::vector<PackedColumn> columns = packed_columns(specs_of(sensor, output));
  const std::filesystem::path file = folder() / "sequence_0000/uav/packed/records.h5";
  // The map of one record gets the packed bytes of another one with a NaN.
  Array map(DType::f32, {6, 5});
  map.as<float>()[7] = std::numeric_limits<float>::quiet_NaN();
  Bytes bytes = read_file(file);
  PackedPlace place = pack_column(columns[8], map, 1, bytes);
  Array table = NpyFile(folder() / "sequence_0000/uav/packed/records.npy").read();
  std::memcpy(table.bytes.data() + (1 * columns.size() + 8) * sizeof place, &place, sizeof place);
  forge("sequence_0000/uav/packed/records.h5", bytes);
  forge("sequence_0000/uav/packed/records.npy", encode_npy(table));
  EXPECT_THAT(problems(),
              HasSubstr("records.h5: record 1: expected finite values, found nan at element 7 of map"));
}

TEST_F(Verify, AFrameOfAnotherSize) {
  forge("sequence_0000/uav/cam/depth/000000.exr", encode_exr(Array(DType::f32, {4, 4})));
  EXPECT_THAT(problems(), HasSubstr("expected <f4 [16, 24], found <f4 [4, 4]"));
}

}  // namespace
}  // namespace greatx::io
