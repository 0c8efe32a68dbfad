// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Writes packed records as HDF5, and reads them. The file has, for a column whose rows vary, a group with a
// dataset "000012" for each record; for any other column one dataset, whose first axis counts the records.
// Each packed column of a record is one chunk with HDF5's own filters shuffle and deflate. A table NAME.npy,
// int64 [records, columns, 5], tells the place of each chunk (PackedPlace). greatx reads the file by this
// table, without the HDF5 library, which is not made for files of unknown origin; other programs read it as
// HDF5 and need no table.
#pragma once

#include <filesystem>
#include <functional>
#include <vector>

#include "io/formats/packed_columns.h"

namespace greatx::io {

/// Returns the packed bytes of a place.
using ReadPacked = std::function<Bytes(const PackedPlace&)>;

/// Writes an HDF5 file of packed records. `places` has a row for each column of each record; their offsets,
/// which `read` understands, become those in the new file. The same records give the same bytes. Throws
/// WriteError.
void write_hdf5_records(const std::filesystem::path& file, const std::vector<PackedColumn>& columns,
                        std::vector<PackedPlace>& places, const ReadPacked& read);

/// Returns the table as a .npy file.
Bytes places_npy(size_t columns, std::span<const PackedPlace> places);

/// Reads packed records by their table. Several threads may load at once.
class PackedRecords {
 public:
  /// `data` is the HDF5 file; of an unfinished sequence, the packed bytes one after another, whose table does
  /// not yet state its length. Throws UserError if the table is not one of these columns.
  PackedRecords(const std::filesystem::path& data, const std::filesystem::path& table,
                std::vector<PackedColumn> columns, bool finished = true);

  int64_t records() const { return records_; }
  const std::vector<PackedColumn>& columns() const { return columns_; }
  const std::filesystem::path& data_path() const { return data_.path(); }
  /// Returns a place that is good (check_place). Throws UserError.
  PackedPlace place(int64_t record, size_t column) const;
  /// Loads an array of a record; `array` is its number in PackedColumn::array. Throws UserError.
  Array load(int64_t record, size_t array) const;
  /// Returns the number of the first records that are complete.
  int64_t whole_records() const;

 private:
  Array load_column(int64_t record, size_t column) const;
  std::vector<PackedColumn> columns_;
  File data_, table_;
  uint64_t data_bytes_ = 0;
  int64_t records_ = 0;
};

}  // namespace greatx::io
