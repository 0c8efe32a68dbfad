// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "view/run/replay.h"

#include <algorithm>
#include <chrono>
#include <set>
#include <utility>
#include <vector>

#include "core/activity.h"
#include "core/error.h"
#include "core/watch.h"
#include "io/dataset/dataset_reader.h"
#include "view/run/record_store.h"
#include "view/run/run_loop.h"

namespace greatx::view {

namespace {

constexpr int ticks_read_ahead = 4;
constexpr uint64_t most_bytes_ahead = most_kept_bytes / 4;  ///< beside what the store keeps
/// The reader keeps the stacks open that it has read. Before they are more files than this, it begins anew.
constexpr size_t most_open_stacks = 200;

/// Knows the records of one sequence.
struct SequenceTable {
  std::vector<int64_t> ticks;                    ///< that have records, ascending
  std::vector<std::vector<uint32_t>> of_sensor;  ///< [sensor] rows of the index, by ticks
};

/// Reads the records of ticks from a data set.
class RecordedTicks : public TickSource {
 public:
  explicit RecordedTicks(std::filesystem::path folder);

  std::shared_ptr<const io::DatasetInfo> info() const override { return info_; }
  int64_t next(uint32_t sequence, int64_t tick) const override;
  int64_t previous(uint32_t sequence, int64_t tick) const override;
  Loaded load(TickAt at, bool goes_on, const std::function<bool()>& unwanted) override;
  bool look_ahead(TickAt at, bool backwards) override;

 private:
  SequenceTable table_of(uint32_t sequence) const;
  /// Returns the newest row of the sensor at or before the tick; null: none.
  const io::IndexRow* newest_row(TickAt at, uint32_t sensor) const;
  std::shared_ptr<const Record> record(uint32_t sequence, const io::IndexRow& row);
  void open_stacks_of(uint32_t sequence);
  void plan_ahead(TickAt at, bool backwards);

  std::filesystem::path folder_;
  std::unique_ptr<io::DatasetReader> reader_;
  std::shared_ptr<const io::DatasetInfo> info_;
  std::vector<std::vector<io::IndexRow>> rows_;  ///< [sequence] as they were when it was opened
  std::vector<SequenceTable> tables_;            ///< [sequence]
  RecordStore store_{most_kept_bytes};
  std::set<uint32_t> damaged_;         ///< sensors whose record could not be read last
  std::set<uint32_t> open_sequences_;  ///< whose stacks may be open
  size_t stacks_per_sequence_ = 0;

  std::pair<TickAt, bool> planned_{{~0u, -1}, false};  ///< tick and direction of the plan
  std::vector<std::pair<uint32_t, const io::IndexRow*>>
      plan_;                  ///< sequence and row, what comes first is last
  uint64_t bytes_ahead_ = 0;  ///< read for the plan
};

RecordedTicks::RecordedTicks(std::filesystem::path folder) : folder_(std::move(folder)) {
  const Activity activity("opening the data set");
  reader_ = std::make_unique<io::DatasetReader>(folder_);
  info_ = std::make_shared<const io::DatasetInfo>(reader_->info());
  for (uint32_t sequence = 0; sequence < reader_->sequences(); ++sequence) {
    checkpoint();
    rows_.push_back(reader_->records(sequence));
    tables_.push_back(table_of(sequence));
  }
  for (const SensorSpec& sensor : info_->sensors)
    for (const OutputSpec& output : sensor.outputs)
      stacks_per_sequence_ += output.format == FileFormat::npy_ragged ? 2
                              : io::is_packed(output.format)          ? 2
                              : io::is_stack(output.format)           ? 1
                                                                      : 0;
}

SequenceTable RecordedTicks::table_of(uint32_t sequence) const {
  SequenceTable table;
  table.of_sensor.resize(info_->sensors.size());
  const std::vector<io::IndexRow>& rows = rows_[sequence];
  if (rows.size() > UINT32_MAX)
    throw_user_error("{}: expected fewer than 2^32 records, found {}",
                     (folder_ / io::index_path(sequence, "npy")).string(), rows.size());
  for (uint32_t i = 0; i < rows.size(); ++i) {
    const io::IndexRow& row = rows[i];
    if (i > 0 && std::pair(rows[i - 1].tick, rows[i - 1].sensor) >= std::pair(row.tick, row.sensor))
      throw_user_error(
          "{}: row {}: expected rows by ascending ticks and sensors, found tick {}, sensor {} "
          "after tick {}, sensor {}",
          (folder_ / io::index_path(sequence, "npy")).string(), i, row.tick, row.sensor, rows[i - 1].tick,
          rows[i - 1].sensor);
    if (table.ticks.empty() || table.ticks.back() != row.tick) table.ticks.push_back(row.tick);
    table.of_sensor[static_cast<size_t>(row.sensor)].push_back(i);
  }
  return table;
}

int64_t RecordedTicks::next(uint32_t sequence, int64_t tick) const {
  if (sequence >= tables_.size()) return -1;
  const std::vector<int64_t>& ticks = tables_[sequence].ticks;
  const auto found = std::lower_bound(ticks.begin(), ticks.end(), tick);
  return found == ticks.end() ? -1 : *found;
}

int64_t RecordedTicks::previous(uint32_t sequence, int64_t tick) const {
  if (sequence >= tables_.size()) return -1;
  const std::vector<int64_t>& ticks = tables_[sequence].ticks;
  const auto found = std::lower_bound(ticks.begin(), ticks.end(), tick);
  return found == ticks.begin() ? -1 : *(found - 1);
}

const io::IndexRow* RecordedTicks::newest_row(TickAt at, uint32_t sensor) const {
  const std::vector<io::IndexRow>& rows = rows_[at.sequence];
  const std::vector<uint32_t>& of_sensor = tables_[at.sequence].of_sensor[sensor];
  const auto after = std::upper_bound(of_sensor.begin(), of_sensor.end(), at.tick,
                                      [&](int64_t tick, uint32_t row) { return tick < rows[row].tick; });
  return after == of_sensor.begin() ? nullptr : &rows[*(after - 1)];
}

/// Begins anew with another reader if too many files would stay open.
void RecordedTicks::open_stacks_of(uint32_t sequence) {
  if (open_sequences_.contains(sequence)) return;
  if (!open_sequences_.empty() && (open_sequences_.size() + 1) * stacks_per_sequence_ > most_open_stacks) {
    reader_ = std::make_unique<io::DatasetReader>(folder_);
    open_sequences_.clear();
  }
  open_sequences_.insert(sequence);
}

std::shared_ptr<const Record> RecordedTicks::record(uint32_t sequence, const io::IndexRow& row) {
  const auto sensor = static_cast<uint32_t>(row.sensor);
  if (RecordStore::Kept kept = store_.find(sequence, sensor, row.tick); kept.record) return kept.record;
  open_stacks_of(sequence);
  const auto record = std::make_shared<const Record>(
      Record{sensor, row.tick, row.time_ns, row.sample, reader_->load_record(sequence, row)});
  store_.put(sequence, {record});
  return record;
}

TickSource::Loaded RecordedTicks::load(TickAt at, bool /*goes_on*/,
                                       const std::function<bool()>& /*unwanted*/) {
  const Activity activity("reading a tick");
  const auto begin = std::chrono::steady_clock::now();
  Loaded loaded;
  store_.begin_turn();
  auto shown = std::make_shared<ShownTick>();
  shown->sequence = at.sequence;
  shown->packet.tick = at.tick;
  for (uint32_t sensor = 0; sensor < info_->sensors.size(); ++sensor) {
    const io::IndexRow* row = newest_row(at, sensor);
    shown->newest.emplace_back();
    if (row == nullptr) continue;
    if (row->tick == at.tick) shown->packet.time_ns = row->time_ns;
    try {
      shown->newest.back() = record(at.sequence, *row);
      damaged_.erase(sensor);
    } catch (const std::bad_alloc&) {
      throw;
    } catch (const Interrupted&) {
      throw;
    } catch (const std::exception& error) {
      loaded.error += fmt::format("{}{}: {} (sequence {}, tick {})", loaded.error.empty() ? "" : "\n",
                                  info_->sensors[sensor].name, error.what(), at.sequence, row->tick);
      loaded.stops |= damaged_.insert(sensor).second;
      continue;
    }
    if (row->tick == at.tick) shown->packet.records.push_back(*shown->newest.back());
  }
  shown->simulated_ms =
      std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - begin).count();
  loaded.tick = std::move(shown);
  return loaded;
}

/// Lists the records to read ahead, the last one first.
void RecordedTicks::plan_ahead(TickAt at, bool backwards) {
  planned_ = {at, backwards};
  plan_.clear();
  bytes_ahead_ = 0;
  store_.begin_turn();
  for (int i = 0; i < ticks_read_ahead; ++i) {
    at.tick = backwards ? previous(at.sequence, at.tick) : next(at.sequence, at.tick + 1);
    if (at.tick < 0) break;
    for (uint32_t sensor = 0; sensor < info_->sensors.size(); ++sensor)
      if (const io::IndexRow* row = newest_row(at, sensor)) plan_.emplace_back(at.sequence, row);
  }
  std::reverse(plan_.begin(), plan_.end());
}

bool RecordedTicks::look_ahead(TickAt at, bool backwards) {
  if (planned_ != std::pair(at, backwards)) plan_ahead(at, backwards);
  while (!plan_.empty() && bytes_ahead_ < most_bytes_ahead) {
    const auto [sequence, row] = plan_.back();
    plan_.pop_back();
    if (store_.has(sequence, static_cast<uint32_t>(row->sensor), row->tick)) continue;
    try {
      bytes_ahead_ += bytes_of(*record(sequence, *row));
    } catch (const Interrupted&) {
      throw;
    } catch (const std::exception&) {
      // Whoever asks for the tick hears of it.
    }
    return true;
  }
  return false;
}

}  // namespace

std::unique_ptr<Run> replay_run(std::filesystem::path folder) {
  return std::make_unique<Looped<Run>>(
      [folder = std::move(folder)] { return std::make_unique<RecordedTicks>(folder); }, false);
}

}  // namespace greatx::view
