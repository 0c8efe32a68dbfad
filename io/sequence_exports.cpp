// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "io/sequence_exports.h"

#include "core/hash.h"
#include "io/event_files.h"

namespace greatx::io {

namespace fs = std::filesystem;

std::vector<FileEntry> export_sequence(const fs::path& folder, const DatasetInfo& info, uint32_t sequence) {
  std::vector<FileEntry> entries;
  for (const SensorSpec& sensor : info.sensors) {
    for (const OutputSpec& output : sensor.outputs) {
      if (!is_export(output.format)) continue;
      const auto stack = [&](size_t i) {
        return part_name(folder / stack_path(sequence, sensor, *ragged_output(sensor, output.arrays[i])));
      };
      const EventArrays events(stack(0), stack(1), stack(2), stack(3));
      const std::string path = export_path(sequence, sensor, output);
      const fs::path part = part_name(folder / path);
      fs::remove(part);
      create_folder_of(part);
      if (output.format == FileFormat::hdf5_events)
        write_hdf5_events(part, events);
      else
        write_text_events(part, events);
      entries.push_back({path, fs::file_size(part), sha256_file(part)});
    }
  }
  return entries;
}

}  // namespace greatx::io
