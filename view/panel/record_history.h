// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Keeps the newest records of a run in memory, so that panels show a live run and a data set alike.
#pragma once

#include <cstdint>
#include <map>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "io/dataset/record_source.h"
#include "view/run/run.h"

namespace greatx::view {

/// Holds records up to a number of bytes. When there are more, the oldest record of the sensor that takes the
/// most bytes goes first, so that pictures do not push out the channel's history. The newest record of every
/// sensor that the last tick showed stays, however large it is. All functions belong to one thread.
class RecordHistory : public io::RecordSource {
 public:
  static constexpr uint64_t most_bytes_usually = uint64_t{256} << 20;
  /// Of one sensor.
  static constexpr size_t most_records = 4096;

  /// `place` begins messages: the data set's folder or the scenario's name.
  RecordHistory(std::shared_ptr<const io::DatasetInfo> info, std::string place,
                uint64_t most_bytes = most_bytes_usually);

  /// Takes the records of the tick. It shares those in ShownTick::newest and copies only what is in the
  /// packet alone. A record that is there already becomes the youngest of its sensor.
  void add(const ShownTick& tick);
  uint64_t bytes() const;

  const io::DatasetInfo& info() const override { return *info_; }
  std::string place() const override { return place_; }
  std::vector<io::IndexRow> records_of(uint32_t sequence, size_t sensor) const override;
  Array load(uint32_t sequence, const io::IndexRow& row, const std::string& array) const override;

 private:
  using Key = std::pair<uint32_t, int64_t>;  ///< sequence and tick
  struct Entry {
    std::shared_ptr<const Record> record;
    uint64_t bytes = 0, age = 0;
  };
  struct Sensor {
    std::map<Key, Entry> entries;
    std::map<uint64_t, Key> by_age;  ///< oldest first
    uint64_t bytes = 0;
    Key shown;  ///< stays
  };
  void put(uint32_t sequence, std::shared_ptr<const Record> record);
  static bool drop_oldest(Sensor& sensor);

  std::shared_ptr<const io::DatasetInfo> info_;
  std::string place_;
  uint64_t most_bytes_, next_age_ = 0;
  std::vector<Sensor> sensors_;
};

}  // namespace greatx::view
