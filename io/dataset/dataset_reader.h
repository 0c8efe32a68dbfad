// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "core/record.h"
#include "io/dataset/dataset_format.h"

namespace greatx::io {

class NpyFile;

/// A data set on disk, finished or not: of an unfinished one, the whole packets are seen. Frames may be
/// loaded by several threads at once, stacks by one.
class DatasetReader {
 public:
  /// Throws UserError if the folder holds no data set or one that cannot be read.
  explicit DatasetReader(const std::filesystem::path& folder);
  ~DatasetReader();
  DatasetReader(DatasetReader&&) noexcept;

  const std::filesystem::path& folder() const { return folder_; }
  const DatasetInfo& info() const { return info_; }
  const std::vector<SensorSpec>& sensors() const { return info_.sensors; }
  bool finished() const { return finished_; }
  /// Sequences that have an index or a whole packet.
  uint32_t sequences() const { return static_cast<uint32_t>(rows_.size()); }
  const std::vector<IndexRow>& records(uint32_t sequence) const { return rows_.at(sequence); }
  /// The records of one sensor.
  std::vector<IndexRow> records_of(uint32_t sequence, size_t sensor) const;

  /// One array of one record, as it was written: [h, w, 3], [n, 4], ... From an output that keeps it exactly
  /// if there is one (of a depth kept as EXR and as 24-bit PNG: the EXR).
  Array load(uint32_t sequence, const IndexRow& row, const std::string& array) const;
  /// Likewise, from one output.
  Array load_output(uint32_t sequence, const IndexRow& row, const OutputSpec& output, size_t array) const;

 private:
  Array load_stack(uint32_t sequence, const IndexRow& row, const OutputSpec& output,
                   const ArraySpec& spec) const;
  Array read_stack_rows(const std::string& path, DType dtype, std::vector<int64_t> row_shape, int64_t first,
                        int64_t last) const;

  std::filesystem::path folder_;
  DatasetInfo info_;
  bool finished_ = false;
  std::vector<std::vector<IndexRow>> rows_;
  mutable std::map<std::string, std::unique_ptr<NpyFile>> open_stacks_;
};

}  // namespace greatx::io
