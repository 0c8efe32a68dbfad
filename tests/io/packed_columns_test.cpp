// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Packed columns come back bit by bit, in the smallest type, and places that lie are refused before memory is
// allocated for them.
#include "io/formats/packed_columns.h"

#include <cmath>
#include <limits>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/random.h"
#include "io/formats/hdf5_records.h"
#include "io/formats/npy.h"
#include "tests/support/temporary_folder.h"

namespace greatx::io {
namespace {

using testing::HasSubstr;

PackedColumn only_column(const ArraySpec& spec) {
  const std::vector<PackedColumn> columns = packed_columns(std::span(&spec, 1));
  EXPECT_EQ(columns.size(), 1u);
  return columns.at(0);
}

/// Packs and unpacks an array; expects the same bytes and returns the place.
PackedPlace expect_round_trip(const PackedColumn& column, const Array& array) {
  Bytes bytes(7);  // a place need not begin at 0
  const PackedPlace place = pack_column(column, array, 6, bytes);
  EXPECT_NO_THROW(check_place(column, place, bytes.size(), "x"));
  const Array back = unpack_column(
      column, place,
      std::span(bytes).subspan(static_cast<size_t>(place.offset), static_cast<size_t>(place.bytes)), "x");
  EXPECT_EQ(back.dtype, array.dtype);
  EXPECT_EQ(back.shape, array.shape);
  EXPECT_EQ(back.bytes, array.bytes);
  return place;
}

PackedPlace expect_times(const std::vector<int64_t>& times) {
  const auto count = static_cast<int64_t>(times.size());
  return expect_round_trip(only_column({"t", DType::i64, {-1}, "ns", ""}),
                           Array::of<int64_t>({count}, times));
}

TEST(PackedColumns, EveryTypeComesBack) {
  RandomStream random(3, 0, 0);
  for (const DType dtype :
       {DType::u8, DType::u16, DType::u32, DType::u64, DType::i8, DType::i32, DType::f32, DType::f64}) {
    for (const std::vector<int64_t>& shape : {std::vector<int64_t>{-1}, {-1, 3}, {5, 7}, {1}, {}}) {
      std::vector<int64_t> found = shape;
      if (!shape.empty() && shape[0] < 0) found[0] = 41;
      Array array(dtype, found);
      for (std::byte& byte : array.bytes) byte = static_cast<std::byte>(random.below(256));
      expect_round_trip(only_column({"a", dtype, shape, "1", ""}), array);
    }
  }
}

TEST(PackedColumns, EmptyRecordsTakeNoBytes) {
  EXPECT_EQ(expect_times({}).bytes, 0);
  EXPECT_EQ(
      expect_round_trip(only_column({"a", DType::f32, {-1, 3}, "1", ""}), Array(DType::f32, {0, 3})).bytes,
      0);
}

TEST(PackedColumns, StepsTakeTheSmallestType) {
  const auto u32 = static_cast<int64_t>(PackedType::u32), i64 = static_cast<int64_t>(PackedType::i64);
  EXPECT_EQ(expect_times({5}).type, u32);
  EXPECT_EQ(expect_times({-7, -7, 0, 4'294'967'295}).type, u32);
  EXPECT_EQ(expect_times({0, 4'294'967'296}).type, i64);  // longer than 32 bits
  EXPECT_EQ(expect_times({9, 8}).type, i64);              // descending
  EXPECT_EQ(expect_times({std::numeric_limits<int64_t>::min(), std::numeric_limits<int64_t>::max(), 0}).type,
            i64);
}

TEST(PackedColumns, MultiplesTakeTheSmallestType) {
  const std::vector<PackedColumn> columns =
      packed_columns(std::vector<ArraySpec>{{"points", DType::f32, {-1, 4}, "m", "", 0.005}});
  ASSERT_EQ(columns.size(), 4u);
  EXPECT_EQ(columns[0].name, "points/x");
  EXPECT_EQ(columns[3].name, "points/intensity");
  EXPECT_EQ(columns[3].coding, PackedColumn::Coding::plain);
  const auto type_of = [&](float value) {
    const float row[] = {value, 0, 0, 0.123f};
    const Array points = Array::of<float>({1, 4}, row);
    Bytes bytes;
    const PackedPlace place = pack_column(columns[0], points, 1, bytes);
    const Array back = unpack_column(columns[0], place, bytes, "x");
    EXPECT_EQ(std::memcmp(back.bytes.data(), &value, sizeof value), 0) << value;
    return static_cast<PackedType>(place.type);
  };
  EXPECT_EQ(type_of(static_cast<float>(0.005 * 32767)), PackedType::i16);
  EXPECT_EQ(type_of(static_cast<float>(0.005 * -32768)), PackedType::i16);
  EXPECT_EQ(type_of(static_cast<float>(0.005 * 32768)), PackedType::i32);
  EXPECT_EQ(type_of(0.1234567f), PackedType::declared);  // no multiple: kept as it is
  EXPECT_EQ(type_of(-0.0f), PackedType::declared);
  EXPECT_EQ(type_of(1e30f), PackedType::declared);
  EXPECT_EQ(type_of(std::numeric_limits<float>::quiet_NaN()), PackedType::declared);
}

TEST(PackedColumns, AHugeRecord) {
  RandomStream random(5, 0, 0);
  std::vector<int64_t> times(20'000'000);
  int64_t now = 0;
  for (int64_t& time : times) time = now += random.below(300);
  const PackedPlace place = expect_times(times);
  EXPECT_LT(place.bytes, 2 * static_cast<int64_t>(times.size()));
}

TEST(PackedColumns, ArraysThatCannotBePacked) {
  const auto fault = [](const std::vector<ArraySpec>& arrays) { return fault_of_packed(arrays); };
  EXPECT_EQ(fault({{"a", DType::f32, {-1}, "", ""}, {"b", DType::u8, {4}, "", ""}}), "");
  EXPECT_THAT(fault({{"a", DType::complex64, {3}, "", ""}}), HasSubstr("complex"));
  EXPECT_THAT(fault({{"a/b", DType::f32, {-1}, "", ""}}), HasSubstr("a name of letters"));
  EXPECT_THAT(fault({{"..", DType::f32, {-1}, "", ""}}), HasSubstr("a name of letters"));
  EXPECT_THAT(fault({{"a", DType::f32, {0, 5}, "", ""}}), HasSubstr("rows of 1 to"));
  EXPECT_THAT(fault({{"a", DType::f32, {1 << 20, 1 << 10}, "", ""}}), HasSubstr("rows of 1 to"));
  EXPECT_THAT(fault({{"t", DType::i64, {-1}, "", ""}, {"t_first", DType::u8, {4}, "", ""}}),
              HasSubstr("share the name t_first"));
  EXPECT_THAT(fault({{"t", DType::i64, {-1}, "", ""}, {"t_steps", DType::u8, {4}, "", ""}}),
              HasSubstr("share the name t_steps"));
}

TEST(PackedColumns, PlacesThatLieAreRefused) {
  const PackedColumn times = only_column({"t", DType::i64, {-1}, "ns", ""}),
                     map = only_column({"map", DType::f32, {6, 5}, "W", ""});
  const auto message = [](const PackedColumn& column, const PackedPlace& place) -> std::string {
    try {
      check_place(column, place, 1000, "file");
    } catch (const UserError& error) {
      return error.what();
    }
    return "";
  };
  EXPECT_EQ(message(times, {100, 50, 10, 1, 0}), "");
  EXPECT_THAT(message(times, {100, 50, 10, 0, 0}), HasSubstr("file: t_steps: expected a type"));
  EXPECT_THAT(message(times, {100, 50, 10, 5, 0}), HasSubstr("expected a type"));
  EXPECT_THAT(message(times, {100, 50, -1, 1, 0}), HasSubstr("a number of rows"));
  EXPECT_THAT(message(times, {100, 50, int64_t{1} << 40, 1, 0}), HasSubstr("a number of rows"));
  EXPECT_THAT(message(times, {100, 50, int64_t{1} << 30, 1, 0}), HasSubstr("a record of at most"));
  EXPECT_THAT(message(times, {960, 50, 10, 1, 0}), HasSubstr("packed bytes within the 1000 of the file"));
  EXPECT_THAT(message(times, {-1, 50, 10, 1, 0}), HasSubstr("packed bytes within"));
  EXPECT_THAT(message(times, {1, std::numeric_limits<int64_t>::max(), 10, 1, 0}),
              HasSubstr("packed bytes within"));
  EXPECT_THAT(message(times, {100, 0, 10, 1, 0}), HasSubstr("packed bytes of 10 rows"));
  EXPECT_THAT(message(times, {100, 50, 0, 1, 0}), HasSubstr("packed bytes of 0 rows"));
  EXPECT_THAT(message(times, {100, 50, 1'000'000, 1, 0}), HasSubstr("packed bytes of 1000000 rows"));
  EXPECT_THAT(message(map, {100, 50, 2, 0, 0}), HasSubstr("expected 1 row"));
  // Bytes that unpack to another size, and bytes that do not unpack.
  Bytes bytes;
  PackedPlace place = pack_column(times, Array(DType::i64, {10}), 6, bytes);
  ++place.rows;
  EXPECT_THROW(unpack_column(times, place, bytes, "file"), UserError);
  --place.rows;
  bytes[0] ^= std::byte{0xff};
  EXPECT_THROW(unpack_column(times, place, bytes, "file"), UserError);
}

TEST(PackedColumns, AFileOfRecordsIsReadByItsTable) {
  const test::TemporaryFolder folder;
  const std::filesystem::path file = folder.path() / "a.h5", table = folder.path() / "a.npy";
  const std::vector<PackedColumn> columns = packed_columns(
      std::vector<ArraySpec>{{"t", DType::i64, {-1}, "ns", ""}, {"m", DType::f32, {3}, "W", ""}});
  const auto write = [&](int64_t records) {
    Bytes stream;
    std::vector<PackedPlace> places;
    for (int64_t r = 0; r < records; ++r) {
      const std::vector<int64_t> times(static_cast<size_t>(r % 4), r);
      const float map[] = {0.5f, static_cast<float>(r), -1.0f};
      places.push_back(pack_column(columns[0], Array::of<int64_t>({r % 4}, times), 1, stream));
      places.push_back(pack_column(columns[1], Array::of<float>({3}, map), 1, stream));
    }
    std::filesystem::remove(file);
    write_hdf5_records(file, columns, places, [&](const PackedPlace& place) {
      const auto part =
          std::span(stream).subspan(static_cast<size_t>(place.offset), static_cast<size_t>(place.bytes));
      return Bytes(part.begin(), part.end());
    });
    write_file_atomically(table, places_npy(columns.size(), places));
    return read_file(file);
  };
  for (const int64_t records : {0, 1, 9, 1000}) {
    const Bytes first = write(records);
    EXPECT_EQ(write(records), first) << records;  // no time of day
    const PackedRecords read(file, table, columns);
    ASSERT_EQ(read.records(), records);
    for (int64_t r = 0; r < records; ++r) {
      EXPECT_EQ(read.load(r, 0).shape[0], r % 4);
      EXPECT_EQ(read.load(r, 1).as<float>()[1], static_cast<float>(r));
    }
    EXPECT_THROW(read.load(records, 0), UserError);
    EXPECT_THROW(read.load(-1, 0), UserError);
  }
  write_file_atomically(table, encode_npy(Array(DType::i64, {4, 1, 5})));
  EXPECT_THROW(PackedRecords(file, table, columns), UserError);
}

}  // namespace
}  // namespace greatx::io
