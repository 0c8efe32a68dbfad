// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Writes the stacks of the open sequence: one file for each npy_stack, two for each npy_ragged and for each
// hdf5_records. Until the sequence is closed, the files have the name PATH.part, and their headers state zero
// rows.
#pragma once

#include <functional>
#include <vector>

#include "io/dataset/dataset_format.h"
#include "io/dataset/journal.h"
#include "io/dataset/packed_stream.h"

namespace greatx::io {

class SequenceFiles {
 public:
  /// Opens or creates every stack and cuts it to the given number of records of its sensor. Throws UserError
  /// if a file holds fewer records.
  SequenceFiles(const std::filesystem::path& folder, const DatasetInfo& info, uint32_t sequence,
                std::vector<int64_t> records_per_sensor);

  /// Appends the record's stacked arrays, and its packed ones, in the order of the outputs. After an
  /// exception the files may hold part of a record. Throws UserError if another process has deleted or
  /// resized a file in the meantime.
  void append(const Record& record, std::span<const PackedRecord> packed);
  int64_t records_of(uint32_t sensor) const { return records_[sensor]; }

  /// Returns the number of complete records in the stacks of each sensor, or INT64_MAX for sensors without
  /// stacks.
  static std::vector<int64_t> whole_records(const std::filesystem::path& folder, const DatasetInfo& info,
                                            uint32_t sequence);
  /// Returns the final paths of all stacks, relative to the data set's folder.
  static std::vector<std::string> stack_paths(const DatasetInfo& info, uint32_t sequence);

  /// Closes the sequence in three steps. seal(i) must be called for i = 0 .. file_count()-1, in any order or
  /// in parallel; it writes the header, hashes the file and closes it, or makes an HDF5 file and its table.
  /// publish() then renames all files. remove_streams() removes what the HDF5 files were made of; it is
  /// called when the end of the sequence is in the journal.
  size_t file_count() const { return files_.size() + packed_.size(); }
  std::vector<FileEntry> seal(size_t file);
  void publish();
  void remove_streams();

 private:
  struct StackFile {
    File file;
    std::string path;  ///< final, relative to the data set's folder
    DType dtype = DType::f32;
    std::vector<int64_t> shape;  ///< shape[0] is the number of rows so far
    uint64_t row_bytes = 0;
    uint64_t bytes_so_far() const;
    void append(std::span<const std::byte> bytes, int64_t rows);
  };
  struct Slot {
    size_t array;  ///< index into SensorSpec::arrays
    size_t file;   ///< index into files_
    bool ragged;   ///< if true, files_[file + 1] holds the offsets
  };
  void open(const std::string& path, DType dtype, std::vector<int64_t> row_shape, int64_t rows);

  std::filesystem::path folder_;
  std::vector<StackFile> files_;
  std::vector<std::vector<Slot>> slots_;  ///< per sensor
  std::vector<PackedStream> packed_;
  std::vector<std::vector<size_t>> packed_of_;  ///< per sensor: indices into packed_
  std::vector<int64_t> records_;                ///< per sensor
};

}  // namespace greatx::io
