// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "io/dataset/sequence_files.h"

#include <algorithm>
#include <limits>

#include "io/files/inside.h"
#include "io/formats/npy.h"

namespace greatx::io {

namespace {

/// Returns the current path of a stack: its final name if the end of the sequence was interrupted after
/// renaming the stack, else its `.part` name.
std::string current_name(const std::filesystem::path& folder, const std::string& final) {
  return exists_inside(folder, final) ? final : final + ".part";
}

/// Returns the number of data bytes after the header of a stack; 0 if the file does not exist.
uint64_t data_bytes(const std::filesystem::path& folder, const std::string& file) {
  const uint64_t size = size_inside(folder, file).value_or(0);
  return size < npy_header_bytes ? 0 : size - npy_header_bytes;
}

int64_t read_offset(const File& file, int64_t row) {
  int64_t value = 0;
  file.read_at(npy_header_bytes + static_cast<uint64_t>(row) * sizeof(int64_t),
               std::as_writable_bytes(std::span(&value, 1)));
  return value;
}

/// Returns the number of complete records of a ragged stack, whose offsets ascend and lie within the data.
int64_t whole_ragged(const std::filesystem::path& folder, const std::string& data, const std::string& offsets,
                     uint64_t row_bytes) {
  const auto entries = static_cast<int64_t>(data_bytes(folder, offsets) / sizeof(int64_t));
  if (entries == 0) return 0;
  const File file = File::open_for_reading(inside(folder, offsets));
  const uint64_t bytes = data_bytes(folder, data);
  std::vector<int64_t> piece(4096);
  int64_t last = 0, records = -1;  // the first offset belongs to no record
  for (int64_t first = 0; first < entries; first += std::ssize(piece)) {
    const auto part =
        std::span(piece).first(static_cast<size_t>(std::min<int64_t>(std::ssize(piece), entries - first)));
    file.read_at(npy_header_bytes + static_cast<uint64_t>(first) * sizeof(int64_t),
                 std::as_writable_bytes(part));
    for (const int64_t offset : part) {
      uint64_t needed = 0;
      const bool whole = offset >= last && (records >= 0 || offset == 0) &&
                         !__builtin_mul_overflow(static_cast<uint64_t>(offset), row_bytes, &needed) &&
                         needed <= bytes;
      if (!whole) return std::max<int64_t>(records, 0);
      last = offset;
      ++records;
    }
  }
  return records;
}

}  // namespace

SequenceFiles::SequenceFiles(const std::filesystem::path& folder, const DatasetInfo& info, uint32_t sequence,
                             std::vector<int64_t> records_per_sensor)
    : folder_(folder),
      slots_(info.sensors.size()),
      packed_of_(info.sensors.size()),
      records_(std::move(records_per_sensor)) {
  GREATX_CHECK(records_.size() == info.sensors.size(), "{} counts", records_.size());
  for (size_t s = 0; s < info.sensors.size(); ++s) {
    const SensorSpec& sensor = info.sensors[s];
    create_folders_inside(folder, sequence_folder(sequence) + "/" + sensor.name);
    for (const OutputSpec& output : sensor.outputs) {
      if (is_export(output.format)) continue;
      if (is_packed(output.format)) {
        packed_of_[s].push_back(packed_.size());
        packed_.emplace_back(folder, sequence, sensor, output, records_[s]);
        continue;
      }
      if (!is_stack(output.format)) {
        create_folders_inside(folder, frame_folder(sequence, sensor, output));
        continue;
      }
      const size_t index = arrays_of(sensor, output)[0];
      const ArraySpec& array = sensor.arrays[index];
      const bool ragged = output.format == FileFormat::npy_ragged;
      const std::string path = stack_path(sequence, sensor, output);
      create_folders_inside(folder, path.substr(0, path.rfind('/')));
      slots_[s].push_back({index, files_.size(), ragged});
      const std::vector<int64_t> row_shape(array.shape.begin() + (ragged ? 1 : 0), array.shape.end());
      if (!ragged) {
        open(path, array.dtype, row_shape, records_[s]);
        continue;
      }
      const std::string offsets = offsets_path(sequence, sensor, output);
      const std::filesystem::path part = inside(folder, offsets + ".part");
      const int64_t rows = records_[s] > 0 ? read_offset(File::open_for_reading(part), records_[s]) : 0;
      open(path, array.dtype, row_shape, rows);
      open(offsets, DType::i64, {}, records_[s] > 0 ? records_[s] + 1 : 0);
      if (records_[s] == 0) {
        constexpr int64_t zero = 0;
        files_.back().append(std::as_bytes(std::span(&zero, 1)), 1);
      }
    }
  }
}

void SequenceFiles::open(const std::string& path, DType dtype, std::vector<int64_t> row_shape, int64_t rows) {
  StackFile stack{
      File::open_for_writing(inside(folder_, path + ".part")), path, dtype, {rows}, size_of(dtype)};
  for (const int64_t extent : row_shape) stack.row_bytes *= static_cast<uint64_t>(extent);
  stack.shape.insert(stack.shape.end(), row_shape.begin(), row_shape.end());
  const uint64_t size = npy_header_bytes + static_cast<uint64_t>(rows) * stack.row_bytes;
  if (rows > 0 && stack.file.size() < size) {
    throw_user_error("{}: expected at least {} bytes, found {}", stack.file.path().string(), size,
                     stack.file.size());
  }
  stack.file.truncate(rows > 0 ? size : 0);
  std::vector<int64_t> shape = stack.shape;
  shape[0] = 0;
  stack.file.write_at(0, npy_header(dtype, shape));
  files_.push_back(std::move(stack));
}

uint64_t SequenceFiles::StackFile::bytes_so_far() const {
  return npy_header_bytes + static_cast<uint64_t>(shape[0]) * row_bytes;
}

void SequenceFiles::StackFile::append(std::span<const std::byte> bytes, int64_t rows) {
  GREATX_CHECK(bytes.size() == static_cast<uint64_t>(rows) * row_bytes, "{}: {} bytes for {} rows of {}",
               path, bytes.size(), rows, row_bytes);
  file.check_untouched(bytes_so_far());
  file.write_at(npy_header_bytes + static_cast<uint64_t>(shape[0]) * row_bytes, bytes);
  shape[0] += rows;
}

void SequenceFiles::append(const Record& record, std::span<const PackedRecord> packed) {
  const std::vector<size_t>& streams = packed_of_[record.sensor];
  GREATX_CHECK(packed.size() == streams.size(), "{} packed records for {} outputs", packed.size(),
               streams.size());
  for (size_t i = 0; i < streams.size(); ++i) packed_[streams[i]].append(packed[i]);
  for (const Slot& slot : slots_[record.sensor]) {
    const Array& array = record.arrays[slot.array];
    StackFile& data = files_[slot.file];
    data.append(array.bytes, slot.ragged ? array.shape[0] : 1);
    if (slot.ragged) files_[slot.file + 1].append(std::as_bytes(std::span(&data.shape[0], 1)), 1);
  }
  ++records_[record.sensor];
}

std::vector<int64_t> SequenceFiles::whole_records(const std::filesystem::path& folder,
                                                  const DatasetInfo& info, uint32_t sequence) {
  std::vector<int64_t> whole;
  for (const SensorSpec& sensor : info.sensors) {
    int64_t count = std::numeric_limits<int64_t>::max();
    for (const OutputSpec& output : sensor.outputs) {
      if (is_packed(output.format))
        count = std::min(count, PackedStream::whole_records(folder, sequence, sensor, output));
      if (!is_stack(output.format)) continue;
      const std::string data = current_name(folder, stack_path(sequence, sensor, output));
      const uint64_t row_bytes = stack_row_bytes(sensor.arrays[arrays_of(sensor, output)[0]]);
      if (output.format == FileFormat::npy_ragged) {
        const std::string offsets = current_name(folder, offsets_path(sequence, sensor, output));
        count = std::min(count, whole_ragged(folder, data, offsets, row_bytes));
      } else if (row_bytes > 0) {
        count = std::min(count, static_cast<int64_t>(data_bytes(folder, data) / row_bytes));
      }
    }
    whole.push_back(count);
  }
  return whole;
}

std::vector<std::string> SequenceFiles::stack_paths(const DatasetInfo& info, uint32_t sequence) {
  std::vector<std::string> paths;
  for (const SensorSpec& sensor : info.sensors) {
    for (const OutputSpec& output : sensor.outputs) {
      if (is_stack(output.format)) paths.push_back(stack_path(sequence, sensor, output));
      if (output.format == FileFormat::npy_ragged) paths.push_back(offsets_path(sequence, sensor, output));
      if (!is_packed(output.format)) continue;
      for (std::string& path : PackedStream::paths(sequence, sensor, output))
        paths.push_back(std::move(path));
    }
  }
  return paths;
}

std::vector<FileEntry> SequenceFiles::seal(size_t index) {
  if (index >= files_.size()) return packed_[index - files_.size()].seal();
  StackFile& stack = files_[index];
  stack.file.check_untouched(stack.bytes_so_far());
  stack.file.write_at(0, npy_header(stack.dtype, stack.shape));
  FileEntry entry{stack.path, stack.bytes_so_far(), sha256_of(stack.file)};
  stack.file.close();
  return {entry};
}

void SequenceFiles::publish() {
  for (const StackFile& stack : files_) rename_file(part_name(folder_ / stack.path), folder_ / stack.path);
  for (const PackedStream& stream : packed_) stream.publish();
}

void SequenceFiles::remove_streams() {
  for (PackedStream& stream : packed_) stream.remove();
}

}  // namespace greatx::io
