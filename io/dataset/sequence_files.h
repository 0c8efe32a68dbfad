// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// The stacks of the sequence that is being written: one open file for each npy_stack, two for each
// npy_ragged. They carry the name PATH.part until the sequence is closed, and until then their header says
// zero rows.
#pragma once

#include <functional>
#include <vector>

#include "io/dataset/dataset_format.h"
#include "io/dataset/journal.h"

namespace greatx::io {

class SequenceFiles {
 public:
  /// Opens or creates every stack and cuts it to the given number of records of each sensor. Throws UserError
  /// if a file has less than that.
  SequenceFiles(const std::filesystem::path& folder, const DatasetInfo& info, uint32_t sequence,
                std::vector<int64_t> records_per_sensor);

  /// Appends the record's stacked arrays. After an exception the files may hold part of a record. A file that
  /// somebody else deleted or cut meanwhile is a UserError.
  void append(const Record& record);
  int64_t records_of(uint32_t sensor) const { return records_[sensor]; }

  /// How many records of each sensor lie whole in its stacks; sensors without stacks: INT64_MAX.
  static std::vector<int64_t> whole_records(const std::filesystem::path& folder, const DatasetInfo& info,
                                            uint32_t sequence);
  /// Final names of all stacks, relative.
  static std::vector<std::string> stack_paths(const DatasetInfo& info, uint32_t sequence);

  /// Closing in two steps: seal(i) for i in 0 .. file_count()-1, in any order or in parallel, writes the
  /// header, closes the file and hashes it; publish() renames them all.
  size_t file_count() const { return files_.size(); }
  FileEntry seal(size_t file);
  void publish();

 private:
  struct StackFile {
    File file;
    std::string path;  ///< final, relative
    DType dtype = DType::f32;
    std::vector<int64_t> shape;  ///< shape[0] is the number of rows so far
    uint64_t row_bytes = 0;
    uint64_t bytes_so_far() const;
    void append(std::span<const std::byte> bytes, int64_t rows);
  };
  struct Slot {
    size_t array;  ///< index into SensorSpec::arrays
    size_t file;   ///< index into files_
    bool ragged;   ///< then files_[file + 1] holds the offsets
  };
  void open(const std::string& path, DType dtype, std::vector<int64_t> row_shape, int64_t rows);

  std::filesystem::path folder_;
  std::vector<StackFile> files_;
  std::vector<std::vector<Slot>> slots_;  ///< per sensor
  std::vector<int64_t> records_;          ///< per sensor
};

}  // namespace greatx::io
