// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Defines the data that the simulator delivers: one Packet per tick, with one Record of every sensor that
// fired. Each Record holds the arrays that its SensorSpec declared before the run. A RecordSink takes the
// packets in the order of ticks. The writer of data sets in io/ is a RecordSink; tests use a vector.
#pragma once

#include <algorithm>
#include <complex>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "core/error.h"

namespace greatx {

enum class DType { u8, u16, u32, u64, i8, i32, i64, f32, f64, complex64 };

size_t size_of(DType dtype);
/// Returns NumPy's little-endian type string, e.g. "<f4", "|u1", "<c8".
std::string_view numpy_name(DType dtype);

template <typename T>
struct DTypeOf;
template <>
struct DTypeOf<uint8_t> {
  static constexpr DType value = DType::u8;
};
template <>
struct DTypeOf<uint16_t> {
  static constexpr DType value = DType::u16;
};
template <>
struct DTypeOf<uint32_t> {
  static constexpr DType value = DType::u32;
};
template <>
struct DTypeOf<uint64_t> {
  static constexpr DType value = DType::u64;
};
template <>
struct DTypeOf<int8_t> {
  static constexpr DType value = DType::i8;
};
template <>
struct DTypeOf<int32_t> {
  static constexpr DType value = DType::i32;
};
template <>
struct DTypeOf<int64_t> {
  static constexpr DType value = DType::i64;
};
template <>
struct DTypeOf<float> {
  static constexpr DType value = DType::f32;
};
template <>
struct DTypeOf<double> {
  static constexpr DType value = DType::f64;
};
template <>
struct DTypeOf<std::complex<float>> {
  static constexpr DType value = DType::complex64;
};

/// Holds a dense array in C order, little-endian, which owns its bytes.
struct Array {
  DType dtype = DType::u8;
  std::vector<int64_t> shape;
  std::vector<std::byte> bytes;

  Array() = default;
  /// Makes an array filled with zeros.
  Array(DType dtype_, std::vector<int64_t> shape_);
  template <typename T>
  static Array of(std::vector<int64_t> shape, std::span<const T> values) {
    Array array(DTypeOf<T>::value, std::move(shape));
    GREATX_CHECK(array.bytes.size() == values.size_bytes(), "{} bytes for {}", array.bytes.size(),
                 values.size_bytes());
    std::copy_n(reinterpret_cast<const std::byte*>(values.data()), values.size_bytes(), array.bytes.begin());
    return array;
  }
  int64_t element_count() const;
  template <typename T>
  std::span<T> as() {
    GREATX_CHECK(DTypeOf<T>::value == dtype, "array of {}", numpy_name(dtype));
    return {reinterpret_cast<T*>(bytes.data()), bytes.size() / sizeof(T)};
  }
  template <typename T>
  std::span<const T> as() const {
    GREATX_CHECK(DTypeOf<T>::value == dtype, "array of {}", numpy_name(dtype));
    return {reinterpret_cast<const T*>(bytes.data()), bytes.size() / sizeof(T)};
  }
};

/// Describes one array that a sensor delivers with every record.
struct ArraySpec {
  std::string name;  ///< e.g. "rgb", "points", "cfr"
  DType dtype = DType::f32;
  std::vector<int64_t> shape;  ///< shape of one record; a first axis of -1 varies between records
  std::string unit;            ///< e.g. "m", "1", "s"
  std::string description;     ///< axes and meaning, in one line
  /// If not 0: values are multiples of it, in `unit`. Of an array [-1, 4] this holds for the first three of a
  /// row, its coordinates. Such values can be stored as small integers.
  double step = 0.0;
};

/// Says how a data set keeps large arrays of records (docs/dataset.md).
enum class Compression {
  none,   ///< as NumPy files, and pictures as fast as they can be written
  fast,   ///< in HDF5 files, packed with little effort
  small,  ///< in HDF5 files, packed well; pictures too
};
/// Returns the name in scenarios and in dataset.json.
constexpr const char* name_of(Compression compression) {
  constexpr const char* names[] = {"none", "fast", "small"};
  return names[static_cast<size_t>(compression)];
}

/// Names the way in which arrays become files.
enum class FileFormat {
  npy_stack,  ///< one .npy per sequence, records stacked along a new first axis
  /// One .npy per sequence holds the records, concatenated along their first axis; NAME_offsets.npy
  /// [records+1] says where each begins.
  npy_ragged,
  npy_frame,    ///< one .npy per record
  png,          ///< u8 [h, w, 3] as 8-bit RGB, or [h, w] as grey; u16 [h, w] as 16-bit grey
  png_depth24,  ///< f32 metres [h, w] as CARLA's 24-bit coding: 1000 m * (R + 256 G + 65536 B) / (2^24 - 1)
  exr,          ///< f32 [h, w] as one channel "Y", [h, w, 3] as R, G, B
  /// Binary little-endian vertices: arrays[0], f32 [n, 4], is x, y, z, intensity; the other arrays [n] are
  /// properties.
  ply,
  // These files of a sequence are made from its npy_ragged arrays when it ends (docs/events.md).
  hdf5_events,  ///< DSEC's HDF5; arrays: t i64 ns, x u16, y u16, p u8
  text_events,  ///< lines "t x y p", t in seconds; the same arrays
  pcd,          ///< PCD 0.7, binary; arrays as ply's
  kitti,        ///< KITTI's velodyne .bin: f32 [n, 4] as it is, no header
  /// One HDF5 file per sequence with several arrays, packed by record, and NAME.npy, the places of the packed
  /// columns (io/formats/packed_columns.h).
  hdf5_records,
};

/// Describes one file series of a sensor.
struct OutputSpec {
  std::string name;  ///< file or folder name below the sensor's folder, e.g. "rgb", "cfr"
  FileFormat format = FileFormat::npy_stack;
  /// Names of the ArraySpecs that the series holds. ply, pcd, hdf5_records and the formats of events hold
  /// several; all others hold one.
  std::vector<std::string> arrays;
};

/// Describes the deliveries of a sensor. It is declared before the run.
struct SensorSpec {
  std::string name;  ///< unique, "node/sensor", also the folder's path in the data set
  std::string kind;  ///< "camera", "lidar", "csi", "pose"
  std::string rate;  ///< as written by the user, e.g. "30", "30000/1001" (Hz)
  std::vector<ArraySpec> arrays;
  std::vector<OutputSpec> outputs;
  std::string metadata_json;  ///< one JSON object: intrinsics, frames, conventions, array geometry, ...
};

/// Holds the measurement of one sensor at one tick.
struct Record {
  uint32_t sensor = 0;  ///< index into the SensorSpecs
  int64_t tick = 0;
  int64_t time_ns = 0;        ///< exact time of the tick, rounded to nanoseconds
  int64_t sample = 0;         ///< number of this record of the sensor, from 0
  std::vector<Array> arrays;  ///< the arrays, in the order of SensorSpec::arrays
};

/// Holds the complete records of every sensor that was due at one tick.
struct Packet {
  int64_t tick = 0;
  int64_t time_ns = 0;
  std::vector<Record> records;  ///< by sensor index, ascending
};

class RecordSink {
 public:
  virtual ~RecordSink() = default;
  /// Takes a packet. Packets come in ascending order of ticks. The call may block to bound memory. It throws
  /// if the packet cannot be kept.
  virtual void write(Packet packet) = 0;
};

}  // namespace greatx
