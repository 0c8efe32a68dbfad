// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "io/dataset/sequence_exports.h"

#include <algorithm>
#include <memory>

#include "io/dataset/packed_stream.h"
#include "io/files/inside.h"
#include "io/formats/event_files.h"

namespace greatx::io {

namespace fs = std::filesystem;

namespace {

/// Reads events from the packed records of a sequence that has been sealed.
class PackedEvents : public EventArrays {
 public:
  PackedEvents(PackedRecords records, const std::vector<size_t>& arrays)
      : records_(std::move(records)), arrays_(arrays), file_(records_.data_path()) {
    const std::vector<PackedColumn>& columns = records_.columns();
    for (size_t c = 0; c < columns.size() && columns[c].array <= arrays_[0]; ++c)
      if (columns[c].array == arrays_[0]) times_ = c;
    for (int64_t r = 0; r < records_.records(); ++r) size_ += records_.place(r, times_).rows;
  }
  int64_t size() const override { return size_; }
  void for_each_piece(const std::function<void(const Piece&)>& visit) const override {
    int64_t first = 0;
    for (int64_t r = 0; r < records_.records(); ++r) {
      Piece piece{first, records_.load(r, arrays_[0]), records_.load(r, arrays_[1]),
                  records_.load(r, arrays_[2]), records_.load(r, arrays_[3])};
      if (piece.size() == 0) continue;
      visit(piece);
      first += piece.size();
    }
  }
  const fs::path& file() const override { return file_; }

 private:
  PackedRecords records_;
  std::vector<size_t> arrays_;  ///< numbers of t, x, y, p in the packed output
  fs::path file_;
  size_t times_ = 0;
  int64_t size_ = 0;
};

/// Opens the events of an export, which one output npy_ragged each or one output hdf5_records keeps.
std::unique_ptr<EventArrays> events_of(const fs::path& folder, uint32_t sequence, const SensorSpec& sensor,
                                       const OutputSpec& output) {
  const OutputSpec& times = *sequence_output(sensor, output.arrays[0]);
  if (is_packed(times.format)) {
    std::vector<size_t> numbers;
    for (const std::string& name : output.arrays) {
      const auto found = std::find(times.arrays.begin(), times.arrays.end(), name);
      GREATX_CHECK(found != times.arrays.end(), "{}: {} keeps no {}", sensor.name, times.name, name);
      numbers.push_back(static_cast<size_t>(found - times.arrays.begin()));
    }
    return std::make_unique<PackedEvents>(open_sealed(folder, sequence, sensor, times), numbers);
  }
  const auto stack = [&](size_t i) {
    return inside(folder, stack_path(sequence, sensor, *sequence_output(sensor, output.arrays[i])) + ".part");
  };
  return std::make_unique<NpyEvents>(stack(0), stack(1), stack(2), stack(3));
}

}  // namespace

std::vector<FileEntry> export_sequence(const fs::path& folder, const DatasetInfo& info, uint32_t sequence) {
  std::vector<FileEntry> entries;
  for (const SensorSpec& sensor : info.sensors) {
    for (const OutputSpec& output : sensor.outputs) {
      if (!is_export(output.format)) continue;
      const std::unique_ptr<EventArrays> events = events_of(folder, sequence, sensor, output);
      const std::string path = export_path(sequence, sensor, output);
      create_folders_inside(folder, path.substr(0, path.rfind('/')));
      const fs::path part = inside(folder, path + ".part");
      fs::remove(part);
      if (output.format == FileFormat::hdf5_events)
        write_hdf5_events(part, *events);
      else
        write_text_events(part, *events);
      const File file = File::open_for_reading(part);
      entries.push_back({path, file.size(), sha256_of(file)});
    }
  }
  return entries;
}

}  // namespace greatx::io
