// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Keeps the packed records of one output hdf5_records while its sequence is open: NAME.chunks.part holds the
// packed bytes of all records, one after another, and NAME.chunks.npy.part their places. When the sequence
// ends, the HDF5 file is put together from the bytes as they are. The two files go only when the end of the
// sequence is in the journal, so that an interrupted end can be repeated.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "io/dataset/dataset_format.h"
#include "io/dataset/journal.h"
#include "io/formats/hdf5_records.h"

namespace greatx::io {

/// Holds the packed columns of one record.
struct PackedRecord {
  Bytes bytes;
  std::vector<PackedPlace> places;  ///< offsets in `bytes`
};
/// Packs the arrays of an output. Any thread may call it.
PackedRecord pack_record(const SensorSpec& sensor, const OutputSpec& output, std::span<const Array> arrays,
                         Compression compression);

/// Opens the packed records of an output for reading; those of an open sequence if `finished` is not set.
PackedRecords open_packed(const std::filesystem::path& folder, uint32_t sequence, const SensorSpec& sensor,
                          const OutputSpec& output, bool finished);
/// Opens the packed records of a sequence whose file has been sealed, but not published.
PackedRecords open_sealed(const std::filesystem::path& folder, uint32_t sequence, const SensorSpec& sensor,
                          const OutputSpec& output);

class PackedStream {
 public:
  /// Opens or creates the files and cuts them to `records`. Throws UserError if they hold fewer.
  PackedStream(const std::filesystem::path& folder, uint32_t sequence, const SensorSpec& sensor,
               const OutputSpec& output, int64_t records);

  /// Appends a record. Throws UserError if another process has deleted or resized a file in the meantime.
  void append(const PackedRecord& record);

  /// Returns the number of complete records in the files of an open sequence.
  static int64_t whole_records(const std::filesystem::path& folder, uint32_t sequence,
                               const SensorSpec& sensor, const OutputSpec& output);
  /// Returns the paths of the two files without ".part", relative to the data set's folder.
  static std::vector<std::string> paths(uint32_t sequence, const SensorSpec& sensor,
                                        const OutputSpec& output);

  /// Ends the sequence in three steps: seal() writes and hashes the HDF5 file and its table, publish() gives
  /// them their names, remove() removes the stream.
  std::vector<FileEntry> seal();
  void publish() const;
  void remove();

 private:
  std::filesystem::path folder_;
  std::string data_path_, places_path_;  ///< final, relative to the folder
  std::vector<PackedColumn> columns_;
  File data_, places_;
  uint64_t data_bytes_ = 0;
  int64_t records_ = 0;
};

}  // namespace greatx::io
