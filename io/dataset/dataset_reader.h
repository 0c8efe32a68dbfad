// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Reads a data set from disk: its description, its index, and single arrays of single records.
#pragma once

#include <filesystem>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

#include "core/record.h"
#include "io/dataset/dataset_format.h"
#include "io/dataset/record_source.h"

namespace greatx::io {

class NpyFile;
class PackedRecords;

/// Reads a finished or unfinished data set. Of an unfinished one, it shows the complete packets. Several
/// threads may load frames and packed records at once, but only one thread at a time may load from stacks.
class DatasetReader : public RecordSource {
 public:
  /// Throws UserError if the folder holds no data set or an unreadable one.
  explicit DatasetReader(const std::filesystem::path& folder);
  ~DatasetReader() override;
  DatasetReader(DatasetReader&&) noexcept;

  const std::filesystem::path& folder() const { return folder_; }
  const DatasetInfo& info() const override { return info_; }
  std::string place() const override { return folder_.string(); }
  bool finished() const { return finished_; }
  /// Returns the number of sequences that have an index or, in an unfinished data set, that the journal
  /// knows.
  uint32_t sequences() const { return static_cast<uint32_t>(rows_.size()); }
  const std::vector<IndexRow>& records(uint32_t sequence) const { return rows_.at(sequence); }
  std::vector<IndexRow> records_of(uint32_t sequence, size_t sensor) const override;

  /// Loads one array of one record in its written shape: [h, w, 3], [n, 4], ... An output that keeps the
  /// array exactly is preferred (EXR to 24-bit PNG for depth). Throws UserError if the file is missing or
  /// does not hold such an array.
  Array load(uint32_t sequence, const IndexRow& row, const std::string& array) const override;
  /// Loads all arrays of one record, in the order of the sensor's arrays, each one like load(). A file that
  /// holds several of them is read once.
  std::vector<Array> load_record(uint32_t sequence, const IndexRow& row) const;
  /// Loads an array from the given output. `array` is an index into OutputSpec::arrays.
  Array load_output(uint32_t sequence, const IndexRow& row, const OutputSpec& output, size_t array) const;

 private:
  /// Holds the properties of the clouds that were read, by output.
  using Clouds = std::map<const OutputSpec*, std::map<std::string, Array>>;
  Array load(uint32_t sequence, const IndexRow& row, const std::string& array, Clouds& clouds) const;
  Array load_output(uint32_t sequence, const IndexRow& row, const OutputSpec& output, size_t array,
                    Clouds& clouds) const;
  Array load_stack(uint32_t sequence, const IndexRow& row, const OutputSpec& output,
                   const ArraySpec& spec) const;
  Array load_packed(uint32_t sequence, const IndexRow& row, const OutputSpec& output, size_t array) const;
  Array read_stack_rows(const std::string& path, DType dtype, std::vector<int64_t> row_shape, int64_t first,
                        int64_t last) const;

  std::filesystem::path folder_;
  DatasetInfo info_;
  bool finished_ = false;
  std::vector<std::vector<IndexRow>> rows_;
  mutable std::map<std::string, std::unique_ptr<NpyFile>> open_stacks_;
  /// Guards the files of packed records, so that several threads may load from them.
  mutable std::unique_ptr<std::mutex> packed_mutex_ = std::make_unique<std::mutex>();
  mutable std::map<std::string, std::shared_ptr<const PackedRecords>> open_packed_;
};

}  // namespace greatx::io
