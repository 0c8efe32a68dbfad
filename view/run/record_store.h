// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Keeps the records that a run has seen, within a bound on their bytes.
#pragma once

#include <compare>
#include <cstdint>
#include <list>
#include <map>
#include <memory>

#include "core/record.h"
#include "sim/run/tick_times.h"

namespace greatx::view {

/// The bytes of the records that a run keeps beside those of the tick that it shows.
inline constexpr uint64_t most_kept_bytes = uint64_t{512} << 20;

/// Holds records by sequence, sensor and tick. It forgets those that nobody has asked for longest.
class RecordStore {
 public:
  /// Holds a record and the times of its tick.
  struct Kept {
    std::shared_ptr<const Record> record;                   ///< null: none
    double milliseconds = 0.0;                              ///< wall time of the tick
    std::shared_ptr<const sim::TickTimes> times = nullptr;  ///< null: unknown
  };

  explicit RecordStore(uint64_t most_bytes) : most_bytes_(most_bytes) {}
  RecordStore(const RecordStore&) = delete;
  RecordStore& operator=(const RecordStore&) = delete;

  /// Begins a turn and forgets records until the rest is within the bound. What was put or found in this turn
  /// or in the one before stays, however large it is.
  void begin_turn();
  /// `kept.record` is not null.
  void put(uint32_t sequence, Kept kept);
  Kept find(uint32_t sequence, uint32_t sensor, int64_t tick);
  /// Returns the newest record of the sensor at or before `tick`.
  Kept newest(uint32_t sequence, uint32_t sensor, int64_t tick);
  /// Tells whether find() would find it. It does not count as asking.
  bool has(uint32_t sequence, uint32_t sensor, int64_t tick) const {
    return entries_.contains(Key{sequence, sensor, tick});
  }
  uint64_t bytes() const { return bytes_; }

 private:
  struct Key {
    uint32_t sequence, sensor;
    int64_t tick;
    friend auto operator<=>(const Key&, const Key&) = default;
  };
  struct Entry {
    Kept kept;
    uint64_t bytes = 0, turn = 0;
    std::list<Key>::iterator place;  ///< in order_
  };
  Kept use(Entry& entry);

  uint64_t most_bytes_, bytes_ = 0, turn_ = 0;
  std::map<Key, Entry> entries_;
  std::list<Key> order_;  ///< last: asked for last
};

/// Returns the bytes that a record takes.
uint64_t bytes_of(const Record& record);

}  // namespace greatx::view
