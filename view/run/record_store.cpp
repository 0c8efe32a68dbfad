// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "view/run/record_store.h"

namespace greatx::view {

uint64_t bytes_of(const Record& record) {
  constexpr uint64_t of_record = 256, of_array = 64;  // about what they take beside their data
  uint64_t bytes = of_record;
  for (const Array& array : record.arrays) bytes += of_array + array.bytes.size();
  return bytes;
}

void RecordStore::begin_turn() {
  ++turn_;
  while (bytes_ > most_bytes_) {
    const auto oldest = entries_.find(order_.front());
    if (oldest->second.turn + 1 >= turn_) return;  // those behind it were asked for later
    bytes_ -= oldest->second.bytes;
    entries_.erase(oldest);
    order_.pop_front();
  }
}

void RecordStore::put(uint32_t sequence, Kept kept) {
  const Key key{sequence, kept.record->sensor, kept.record->tick};
  const auto [found, is_new] = entries_.try_emplace(key);
  Entry& entry = found->second;
  if (is_new) entry.place = order_.insert(order_.end(), key);
  // The records of a tick share its times. Each counts them, because any of them may be the last to go.
  const uint64_t bytes = bytes_of(*kept.record) + (kept.times ? sim::bytes_of(*kept.times) : 0);
  bytes_ += bytes - entry.bytes;
  entry.bytes = bytes;
  entry.kept = std::move(kept);
  use(entry);
}

RecordStore::Kept RecordStore::use(Entry& entry) {
  order_.splice(order_.end(), order_, entry.place);
  entry.turn = turn_;
  return entry.kept;
}

RecordStore::Kept RecordStore::find(uint32_t sequence, uint32_t sensor, int64_t tick) {
  const auto found = entries_.find(Key{sequence, sensor, tick});
  return found == entries_.end() ? Kept{} : use(found->second);
}

RecordStore::Kept RecordStore::newest(uint32_t sequence, uint32_t sensor, int64_t tick) {
  auto after = entries_.upper_bound(Key{sequence, sensor, tick});
  if (after == entries_.begin()) return {};
  --after;
  if (after->first.sequence != sequence || after->first.sensor != sensor) return {};
  return use(after->second);
}

}  // namespace greatx::view
