// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Where records are read from: a data set on disk (DatasetReader), or packets in memory.
#pragma once

#include <string>
#include <vector>

#include "core/record.h"
#include "io/dataset/dataset_format.h"

namespace greatx::io {

/// Records by sequence and sensor. One thread at a time may use a source.
class RecordSource {
 public:
  virtual ~RecordSource() = default;
  virtual const DatasetInfo& info() const = 0;
  /// Returns the folder, or another name, with which messages begin.
  virtual std::string place() const = 0;
  /// Returns the records of one sensor that are there, ascending by tick. `sequence` and `sensor` must exist.
  virtual std::vector<IndexRow> records_of(uint32_t sequence, size_t sensor) const = 0;
  /// Loads one array of one record in the shape that the sensor declared. Throws UserError if the array is
  /// not there or differs from its declaration.
  virtual Array load(uint32_t sequence, const IndexRow& row, const std::string& array) const = 0;

  const std::vector<SensorSpec>& sensors() const { return info().sensors; }

 protected:
  RecordSource() = default;
  RecordSource(const RecordSource&) = default;
  RecordSource(RecordSource&&) = default;
  RecordSource& operator=(const RecordSource&) = default;
  RecordSource& operator=(RecordSource&&) = default;
};

}  // namespace greatx::io
