// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "io/dataset/sequence_exports.h"

#include "io/files/inside.h"
#include "io/formats/event_files.h"

namespace greatx::io {

namespace fs = std::filesystem;

std::vector<FileEntry> export_sequence(const fs::path& folder, const DatasetInfo& info, uint32_t sequence) {
  std::vector<FileEntry> entries;
  for (const SensorSpec& sensor : info.sensors) {
    for (const OutputSpec& output : sensor.outputs) {
      if (!is_export(output.format)) continue;
      const auto stack = [&](size_t i) {
        return inside(folder,
                      stack_path(sequence, sensor, *ragged_output(sensor, output.arrays[i])) + ".part");
      };
      const EventArrays events(stack(0), stack(1), stack(2), stack(3));
      const std::string path = export_path(sequence, sensor, output);
      create_folders_inside(folder, path.substr(0, path.rfind('/')));
      const fs::path part = inside(folder, path + ".part");
      fs::remove(part);
      if (output.format == FileFormat::hdf5_events)
        write_hdf5_events(part, events);
      else
        write_text_events(part, events);
      const File file = File::open_for_reading(part);
      entries.push_back({path, file.size(), sha256_of(file)});
    }
  }
  return entries;
}

}  // namespace greatx::io
