// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "view/panel/record_history.h"

#include <algorithm>
#include <filesystem>
#include <limits>

#include <fmt/ranges.h>

namespace greatx::view {

namespace {

/// A record's arrays and, roughly, what its bookkeeping takes.
uint64_t size_of_record(const Record& record) {
  uint64_t bytes = sizeof(Record) + 160;
  for (const Array& array : record.arrays)
    bytes += sizeof(Array) + array.bytes.size() + array.shape.size() * sizeof(int64_t);
  return bytes;
}

bool is_declared(const ArraySpec& spec, const Array& array) {
  bool fits = array.dtype == spec.dtype && array.shape.size() == spec.shape.size();
  for (size_t axis = 0; fits && axis < spec.shape.size(); ++axis)
    fits = spec.shape[axis] < 0 || spec.shape[axis] == array.shape[axis];
  return fits;
}

}  // namespace

RecordHistory::RecordHistory(std::shared_ptr<const io::DatasetInfo> info, std::string place,
                             uint64_t most_bytes)
    : info_(std::move(info)),
      place_(std::move(place)),
      most_bytes_(most_bytes),
      sensors_(info_->sensors.size()) {}

uint64_t RecordHistory::bytes() const {
  uint64_t sum = 0;
  for (const Sensor& sensor : sensors_) sum += sensor.bytes;
  return sum;
}

void RecordHistory::add(const ShownTick& tick) {
  for (const std::shared_ptr<const Record>& record : tick.newest)
    if (record != nullptr) put(tick.sequence, record);
  for (const Record& record : tick.packet.records) {
    const bool shared = record.sensor < tick.newest.size() && tick.newest[record.sensor] != nullptr &&
                        tick.newest[record.sensor]->tick == record.tick;
    if (!shared) put(tick.sequence, std::make_shared<const Record>(record));
  }
  uint64_t left = bytes();
  while (left > most_bytes_) {
    Sensor& largest = *std::ranges::max_element(
        sensors_, {}, [](const Sensor& sensor) { return sensor.entries.size() > 1 ? sensor.bytes : 0; });
    if (!drop_oldest(largest)) break;
    left = bytes();
  }
}

void RecordHistory::put(uint32_t sequence, std::shared_ptr<const Record> record) {
  GREATX_CHECK(record->sensor < sensors_.size(), "a record of sensor {} of {}", record->sensor,
               sensors_.size());
  Sensor& sensor = sensors_[record->sensor];
  const Key key{sequence, record->tick};
  Entry& entry = sensor.entries[key];
  if (entry.record != nullptr) sensor.by_age.erase(entry.age);
  sensor.bytes -= entry.bytes;
  entry.bytes = size_of_record(*record);
  entry.record = std::move(record);
  entry.age = next_age_++;
  sensor.bytes += entry.bytes;
  sensor.by_age.emplace(entry.age, key);
  sensor.shown = key;
  while (sensor.entries.size() > most_records) drop_oldest(sensor);
}

bool RecordHistory::drop_oldest(Sensor& sensor) {
  const auto oldest = sensor.by_age.begin();
  if (oldest == sensor.by_age.end() || oldest->second == sensor.shown) return false;
  const auto entry = sensor.entries.find(oldest->second);
  sensor.bytes -= entry->second.bytes;
  sensor.entries.erase(entry);
  sensor.by_age.erase(oldest);
  return true;
}

std::vector<io::IndexRow> RecordHistory::records_of(uint32_t sequence, size_t sensor) const {
  const auto& entries = sensors_.at(sensor).entries;
  std::vector<io::IndexRow> rows;
  for (auto at = entries.lower_bound(Key{sequence, std::numeric_limits<int64_t>::min()});
       at != entries.end() && at->first.first == sequence; ++at) {
    const Record& record = *at->second.record;
    rows.push_back({record.tick, record.time_ns, record.sensor, record.sample, std::ssize(rows)});
  }
  return rows;
}

Array RecordHistory::load(uint32_t sequence, const io::IndexRow& row, const std::string& array) const {
  const SensorSpec& spec = info_->sensors.at(static_cast<size_t>(row.sensor));
  const auto where = [&] {
    return fmt::format("{}, tick {}",
                       (std::filesystem::path(place_) / io::sequence_folder(sequence) / spec.name).string(),
                       row.tick);
  };
  const auto& entries = sensors_[static_cast<size_t>(row.sensor)].entries;
  const auto found = entries.find({sequence, row.tick});
  if (found == entries.end()) throw_user_error("{}: the record is no longer kept", where());
  const auto declared = std::ranges::find(spec.arrays, array, &ArraySpec::name);
  GREATX_CHECK(declared != spec.arrays.end(), "{} has no array {}", spec.name, array);
  const std::vector<Array>& arrays = found->second.record->arrays;
  const auto index = static_cast<size_t>(declared - spec.arrays.begin());
  if (index >= arrays.size())
    throw_user_error("{}: expected {} arrays, among them {}, found {}", where(), spec.arrays.size(), array,
                     arrays.size());
  if (!is_declared(*declared, arrays[index]))
    throw_user_error("{}: {}: expected {} [{}], found {} [{}]", where(), array, numpy_name(declared->dtype),
                     fmt::join(declared->shape, ", "), numpy_name(arrays[index].dtype),
                     fmt::join(arrays[index].shape, ", "));
  return arrays[index];
}

}  // namespace greatx::view
