// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "io/dataset/dataset_reader.h"

#include <algorithm>
#include <cstring>

#include "io/dataset/expect_dataset.h"
#include "io/dataset/packed_stream.h"
#include "io/dataset/recovery.h"
#include "io/files/inside.h"
#include "io/files/untrusted_json.h"
#include "io/formats/exr.h"
#include "io/formats/npy.h"
#include "io/formats/pcd.h"
#include "io/formats/ply.h"
#include "io/formats/png.h"

namespace greatx::io {

namespace fs = std::filesystem;

namespace {

std::vector<std::vector<IndexRow>> rows_of_journal(const fs::path& folder, const DatasetInfo& info) {
  const Recovered recovered = read_committed(folder, info);
  std::vector<std::vector<IndexRow>> sequences(recovered.closed.size());
  std::vector<int64_t> counts(info.sensors.size());
  // read_committed() guarantees that the packets are in order of sequences.
  for (const JournalPacket& packet : recovered.packets) {
    if (packet.sequence >= sequences.size()) sequences.resize(packet.sequence + 1);
    if (sequences[packet.sequence].empty()) std::fill(counts.begin(), counts.end(), 0);
    for (const auto& record : packet.records) {
      sequences[packet.sequence].push_back(
          {packet.tick, packet.time_ns, record.sensor, record.sample, counts.at(record.sensor)++});
    }
  }
  return sequences;
}

Array points_of(const std::map<std::string, Array>& properties, const std::string& file) {
  const char* const names[] = {"x", "y", "z", "intensity"};
  Array points;
  for (size_t c = 0; c < 4; ++c) {
    const auto found = properties.find(names[c]);
    if (found == properties.end() || found->second.dtype != DType::f32)
      throw_user_error("{}: expected a float property {}", file, names[c]);
    if (c == 0) points = Array(DType::f32, {found->second.shape[0], 4});
    const std::span<const float> column = found->second.as<float>();
    for (size_t i = 0; i < column.size(); ++i) points.as<float>()[4 * i + c] = column[i];
  }
  return points;
}

/// Reads an array of the shape that the sensor declares. Throws UserError if the file states another shape,
/// because a sparse file could state any size.
Array read_npy_frame(const fs::path& path, const ArraySpec& spec) {
  const NpyFile file(path);
  bool fits = file.shape().size() == spec.shape.size();
  for (size_t i = 0; fits && i < spec.shape.size(); ++i)
    fits = spec.shape[i] < 0 || spec.shape[i] == file.shape()[i];
  if (!fits || file.file_bytes() > largest_array)
    throw_user_error("{}: expected {} [{}], found {} [{}]", path.string(), numpy_name(spec.dtype),
                     fmt::join(spec.shape, ", "), numpy_name(file.dtype()), fmt::join(file.shape(), ", "));
  return file.read();
}

Array widened(const Array& grey16) {
  Array ids(DType::u32, grey16.shape);
  std::copy(grey16.as<uint16_t>().begin(), grey16.as<uint16_t>().end(), ids.as<uint32_t>().begin());
  return ids;
}

/// Returns u32 of i32, as PLY stores it. Throws UserError for a negative number.
Array unsigned_of(Array ids, const std::string& file, const std::string& property) {
  const std::span<const int32_t> values = ids.as<int32_t>();
  const auto least = std::min_element(values.begin(), values.end());
  if (least != values.end() && *least < 0)
    throw_user_error("{}: {}: expected numbers from 0 on, found {}", file, property, *least);
  ids.dtype = DType::u32;
  return ids;
}

}  // namespace

DatasetReader::DatasetReader(const fs::path& folder) : folder_(folder) {
  expect_dataset(folder);
  const fs::path description = folder / dataset_file;
  info_ = parse_dataset_json(read_text_file(description, JsonLimits{}.bytes), description.string());
  info_.scenario_text = read_text_file(inside(folder, scenario_file), JsonLimits{}.bytes);
  finished_ = exists_inside(folder, manifest_file);
  if (!finished_) {
    rows_ = rows_of_journal(folder, info_);
    return;
  }
  for (uint32_t sequence = 0; sequence < info_.sequences; ++sequence) {
    const fs::path index = inside(folder, index_path(sequence, "npy"));
    rows_.push_back(read_index_npy(index));
    check_index_rows(index.string(), info_, rows_.back());
  }
}
DatasetReader::~DatasetReader() = default;
DatasetReader::DatasetReader(DatasetReader&&) noexcept = default;

std::vector<IndexRow> DatasetReader::records_of(uint32_t sequence, size_t sensor) const {
  std::vector<IndexRow> rows;
  std::copy_if(records(sequence).begin(), records(sequence).end(), std::back_inserter(rows),
               [&](const IndexRow& row) { return row.sensor == static_cast<int64_t>(sensor); });
  return rows;
}

Array DatasetReader::load(uint32_t sequence, const IndexRow& row, const std::string& array) const {
  Clouds clouds;
  return load(sequence, row, array, clouds);
}

std::vector<Array> DatasetReader::load_record(uint32_t sequence, const IndexRow& row) const {
  Clouds clouds;
  std::vector<Array> arrays;
  for (const ArraySpec& array : info_.sensors.at(static_cast<size_t>(row.sensor)).arrays)
    arrays.push_back(load(sequence, row, array.name, clouds));
  return arrays;
}

Array DatasetReader::load(uint32_t sequence, const IndexRow& row, const std::string& array,
                          Clouds& clouds) const {
  const SensorSpec& sensor = info_.sensors.at(static_cast<size_t>(row.sensor));
  const OutputSpec* choice = nullptr;
  for (const OutputSpec& output : sensor.outputs) {
    if (is_export(output.format)) continue;
    if (std::find(output.arrays.begin(), output.arrays.end(), array) == output.arrays.end()) continue;
    if (choice == nullptr || choice->format == FileFormat::png_depth24) choice = &output;
  }
  GREATX_CHECK(choice != nullptr, "{} has no array {}", sensor.name, array);
  const auto index = std::find(choice->arrays.begin(), choice->arrays.end(), array) - choice->arrays.begin();
  return load_output(sequence, row, *choice, static_cast<size_t>(index), clouds);
}

Array DatasetReader::load_output(uint32_t sequence, const IndexRow& row, const OutputSpec& output,
                                 size_t array) const {
  Clouds clouds;
  return load_output(sequence, row, output, array, clouds);
}

Array DatasetReader::load_output(uint32_t sequence, const IndexRow& row, const OutputSpec& output,
                                 size_t array, Clouds& clouds) const {
  const SensorSpec& sensor = info_.sensors.at(static_cast<size_t>(row.sensor));
  const ArraySpec& spec = sensor.arrays[arrays_of(sensor, output).at(array)];
  if (is_stack(output.format)) return load_stack(sequence, row, output, spec);
  if (is_packed(output.format)) return load_packed(sequence, row, output, array);
  const fs::path path = inside(folder_, frame_path(sequence, sensor, output, row.sample));
  const bool varies = is_cloud(output.format) || (!spec.shape.empty() && spec.shape[0] < 0);
  // A compressed picture is hardly larger than its pixels, so twice their size is a safe bound.
  const uint64_t most_bytes = varies ? largest_read : 2 * stack_row_bytes(spec) + (uint64_t{1} << 20);
  Array result;
  switch (output.format) {
    case FileFormat::npy_frame:
      result = read_npy_frame(path, spec);
      break;
    case FileFormat::png:
      result = decode_png(read_file(path, most_bytes), path.string(), spec.shape);
      break;
    case FileFormat::png_depth24:
      result = decode_png_depth24(read_file(path, most_bytes), path.string(), spec.shape);
      break;
    case FileFormat::exr:
      result = read_exr(path, spec.shape);
      break;
    case FileFormat::kitti:
      result = decode_kitti(read_file(path), path.string());
      break;
    default: {
      const auto [cloud, is_new] = clouds.try_emplace(&output);
      std::map<std::string, Array>& properties = cloud->second;
      if (is_new) {
        const Bytes file = read_file(path);
        properties = output.format == FileFormat::ply ? decode_ply(file, path.string())
                                                      : decode_pcd(file, path.string());
      }
      if (array == 0)
        result = points_of(properties, path.string());
      else if (const auto found = properties.find(spec.name); found != properties.end())
        result = found->second;
      else
        throw_user_error("{}: expected a property {}", path.string(), spec.name);
    }
  }
  if (output.format == FileFormat::png && spec.dtype == DType::u32 && result.dtype == DType::u16)
    result = widened(result);
  if (output.format == FileFormat::ply && spec.dtype == DType::u32 && result.dtype == DType::i32)
    result = unsigned_of(std::move(result), path.string(), spec.name);
  std::vector<int64_t> expected = spec.shape;
  if (!expected.empty() && expected[0] < 0 && !result.shape.empty()) expected[0] = result.shape[0];
  if (result.dtype != spec.dtype || result.shape != expected) {
    throw_user_error("{}: expected {} [{}], found {} [{}]", path.string(), numpy_name(spec.dtype),
                     fmt::join(spec.shape, ", "), numpy_name(result.dtype), fmt::join(result.shape, ", "));
  }
  return result;
}

Array DatasetReader::load_stack(uint32_t sequence, const IndexRow& row, const OutputSpec& output,
                                const ArraySpec& spec) const {
  const SensorSpec& sensor = info_.sensors[static_cast<size_t>(row.sensor)];
  const std::string path = stack_path(sequence, sensor, output);
  if (output.format == FileFormat::npy_stack) {
    Array array = read_stack_rows(path, spec.dtype, spec.shape, row.row, row.row + 1);
    array.shape = spec.shape;
    return array;
  }
  const Array offsets =
      read_stack_rows(offsets_path(sequence, sensor, output), DType::i64, {}, row.row, row.row + 2);
  return read_stack_rows(path, spec.dtype, {spec.shape.begin() + 1, spec.shape.end()},
                         offsets.as<int64_t>()[0], offsets.as<int64_t>()[1]);
}

Array DatasetReader::load_packed(uint32_t sequence, const IndexRow& row, const OutputSpec& output,
                                 size_t array) const {
  const SensorSpec& sensor = info_.sensors[static_cast<size_t>(row.sensor)];
  const std::string path = packed_path(sequence, sensor, output);
  std::shared_ptr<const PackedRecords> records;
  {
    const std::lock_guard lock(*packed_mutex_);
    std::shared_ptr<const PackedRecords>& opened = open_packed_[path];
    // An unfinished sequence grows, so its table is opened anew.
    const bool finished = exists_inside(folder_, path);
    if (!opened || !finished)
      opened =
          std::make_shared<const PackedRecords>(open_packed(folder_, sequence, sensor, output, finished));
    records = opened;
  }
  return records->load(row.row, array);
}

Array DatasetReader::read_stack_rows(const std::string& path, DType dtype, std::vector<int64_t> row_shape,
                                     int64_t first, int64_t last) const {
  row_shape.insert(row_shape.begin(), last - first);
  uint64_t row_bytes = size_of(dtype), bytes = 0;
  for (size_t axis = 1; axis < row_shape.size(); ++axis)
    row_bytes *= static_cast<uint64_t>(row_shape[axis]);  // parsing dataset.json has bounded the product
  const bool sized = first >= 0 && first <= last &&
                     !__builtin_mul_overflow(static_cast<uint64_t>(last - first), row_bytes, &bytes) &&
                     bytes <= largest_array;
  const fs::path whole = inside(folder_, path);
  if (!sized)
    throw_user_error("{}: expected a record of at most {} bytes, found rows {} to {} of {}", whole.string(),
                     largest_array, first, last, row_bytes);
  if (exists_inside(folder_, path)) {
    std::unique_ptr<NpyFile>& file = open_stacks_[path];
    if (!file) file = std::make_unique<NpyFile>(whole);
    std::vector<int64_t> shape = file->shape();
    const int64_t rows = file->rows();
    if (!shape.empty()) shape[0] = last - first;
    if (file->dtype() != dtype || shape != row_shape || last > rows) {
      throw_user_error("{}: expected rows {} to {} of {} [{}], found {} [{}]", whole.string(), first, last,
                       numpy_name(dtype), fmt::join(row_shape, ", "), numpy_name(file->dtype()),
                       fmt::join(file->shape(), ", "));
    }
    return file->read_rows(first, last);
  }
  // The stack is unfinished, and its header does not yet state the number of rows.
  const File file = File::open_for_reading(inside(folder_, path + ".part"));
  const uint64_t size = file.size(), stored = size < npy_header_bytes ? 0 : size - npy_header_bytes;
  if (row_bytes > 0 && stored / row_bytes < static_cast<uint64_t>(last))
    throw_user_error("{}: expected {} rows of {} bytes, found {} bytes", file.path().string(), last,
                     row_bytes, stored);
  Array array(dtype, row_shape);
  if (last > first) file.read_at(npy_header_bytes + static_cast<uint64_t>(first) * row_bytes, array.bytes);
  return array;
}

}  // namespace greatx::io
