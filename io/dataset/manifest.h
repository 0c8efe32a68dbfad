// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Writes and reads manifest.json, which lists every file of the data set with its size and SHA-256, and the
// totals. The manifest is written last, so a data set with a manifest is complete. The order of the files is
// fixed: dataset.json, scenario.yaml, the stacks, exports and indices of the sequences, then the frames in
// order of their commit.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "io/dataset/dataset_format.h"
#include "io/dataset/journal.h"

namespace greatx::io {

/// Collects the entries of the manifest during a run. A Frame takes only 64 bytes, because there may be
/// millions.
struct Manifest {
  struct Frame {
    uint32_t sequence = 0, sensor = 0, output = 0;
    int64_t sample = 0;
    uint64_t size = 0;
    std::array<uint8_t, 32> digest{};
  };
  int64_t packets = 0;
  std::vector<int64_t> records_per_sensor;
  std::vector<FileEntry> files;  ///< all files except frames
  std::vector<Frame> frames;

  void add_frame(Frame frame, const std::string& sha256);
};

/// Writes manifest.json atomically. Returns the number of files and their total size in bytes, without the
/// manifest itself. Throws WriteError.
std::pair<int64_t, uint64_t> write_manifest(const std::filesystem::path& folder, const DatasetInfo& info,
                                            const Manifest& manifest);
/// Returns the files that manifest.json lists. Throws UserError if it cannot be read or is not valid.
std::vector<FileEntry> read_manifest(const std::filesystem::path& folder);

}  // namespace greatx::io
