// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "view/run/live.h"

#include <chrono>
#include <mutex>
#include <optional>
#include <utility>
#include <vector>

#include <fmt/ranges.h>

#include "core/activity.h"
#include "core/error.h"
#include "core/watch.h"
#include "gpu/memory_use.h"
#include "sim/dataset/dataset_info.h"
#include "sim/run/simulator.h"
#include "view/run/run_loop.h"

namespace greatx::view {

namespace {

/// To a tick that is at most so many due ticks ahead, the simulator goes tick by tick. To others it starts
/// anew, which searches again where a channel searches at every tick.
constexpr int most_ticks_gone_through = 8;

/// Hands the experiment from the run's thread to others.
class Handover {
 public:
  void give(std::shared_ptr<const sim::Experiment> experiment) {
    const std::lock_guard lock(mutex_);
    experiment_ = std::move(experiment);
  }
  std::shared_ptr<const sim::Experiment> take() const {
    const std::lock_guard lock(mutex_);
    return experiment_;
  }

 private:
  mutable std::mutex mutex_;
  std::shared_ptr<const sim::Experiment> experiment_;
};

/// Simulates ticks and keeps their records. After an error it drops the simulator and makes another one,
/// because the old one may have stopped anywhere in a tick.
class SimulatedTicks : public TickSource, private RecordSink {
 public:
  SimulatedTicks(const LiveOptions& options, Handover& handover);

  std::shared_ptr<const io::DatasetInfo> info() const override { return info_; }
  int64_t next(uint32_t /*sequence*/, int64_t tick) const override {
    const int64_t end = experiment_->scenario.ticks, found = tick < end ? schedule_->next(tick, end) : end;
    return found < end ? found : -1;
  }
  int64_t previous(uint32_t /*sequence*/, int64_t tick) const override { return schedule_->previous(tick); }
  Loaded load(TickAt at, bool goes_on, const std::function<bool()>& unwanted) override;

 private:
  using WallClock = std::chrono::steady_clock;
  void make_simulator();
  void drop_simulator(const std::exception& error);
  bool kept(TickAt at) const;
  bool leads_to(TickAt at) const;
  void simulate(TickAt at, bool goes_on, const std::function<bool()>& unwanted);
  void write(Packet packet) override;
  std::shared_ptr<const ShownTick> assemble(TickAt at);
  RunMemory memory() const;
  std::string validation_messages() const;

  gpu::DeviceOptions device_options_;
  std::shared_ptr<const sim::Experiment> experiment_;
  std::unique_ptr<gpu::Device> device_;
  std::unique_ptr<sim::Simulator> simulator_;
  std::optional<sim::Schedule> schedule_;
  std::shared_ptr<const io::DatasetInfo> info_;
  RecordStore store_;
  std::shared_ptr<const ShownTick> last_;  ///< returned last

  uint32_t sequence_ = 0;             ///< of the simulator
  std::optional<int64_t> in_flight_;  ///< recorded, not yet collected
  WallClock::time_point since_;       ///< of the work on the present packet
  double earlier_ms_ = 0.0;           ///< work on it before `since_`
};

SimulatedTicks::SimulatedTicks(const LiveOptions& options, Handover& handover)
    : device_options_(options.device), store_(options.kept_bytes) {
  {
    const Activity activity("loading the scene");
    sim::Scenario scenario = options.scenario();
    experiment_ = std::make_shared<const sim::Experiment>(
        options.before ? sim::make_experiment(std::move(scenario), *options.before)
                       : sim::make_experiment(std::move(scenario)));
  }
  handover.give(experiment_);
  checkpoint();
  make_simulator();
  schedule_ = simulator_->schedule();
  info_ = std::make_shared<const io::DatasetInfo>(
      sim::dataset_info(*experiment_, *device_, simulator_->sensors()));
}

void SimulatedTicks::make_simulator() {
  if (simulator_ != nullptr) return;
  if (device_ == nullptr) {
    const Activity activity("opening the device");
    device_ = std::make_unique<gpu::Device>(device_options_);
  }
  checkpoint();
  const Activity activity("preparing the sensors");
  in_flight_.reset();
  sequence_ = ~0u;
  simulator_ = std::make_unique<sim::Simulator>(*device_, *experiment_);
  simulator_->keep_tick_times(true);
}

void SimulatedTicks::drop_simulator(const std::exception& error) {
  simulator_.reset();
  in_flight_.reset();
  if (dynamic_cast<const gpu::VulkanError*>(&error) != nullptr) device_.reset();  // it may be lost
}

/// Tells whether the store has all records of the tick.
bool SimulatedTicks::kept(TickAt at) const {
  for (const sim::Due& due : schedule_->due(at.tick, 0))
    if (!store_.has(at.sequence, due.sensor, at.tick)) return false;
  return true;
}

/// Tells whether the simulator gets to the tick from where it is, at less work than from a new start.
bool SimulatedTicks::leads_to(TickAt at) const {
  if (simulator_ == nullptr || sequence_ != at.sequence) return false;
  if (in_flight_ == at.tick) return true;
  int64_t tick = simulator_->next_tick();
  if (tick > at.tick) return false;
  if (simulator_->remembers()) return true;  // a new start runs through all ticks
  for (int ticks = 0; ticks < most_ticks_gone_through; ++ticks) {
    if (tick == at.tick) return true;
    tick = schedule_->next(tick + 1, experiment_->scenario.ticks);
  }
  return false;
}

TickSource::Loaded SimulatedTicks::load(TickAt at, bool goes_on, const std::function<bool()>& unwanted) {
  if (!kept(at)) {
    // The error may be that of another tick on the way, or of the next one. The tick by itself decides.
    const bool alone = !goes_on && !leads_to(at) && !in_flight_;
    try {
      simulate(at, goes_on, unwanted);
    } catch (const std::exception& error) {
      drop_simulator(error);
      if (alone || dynamic_cast<const Interrupted*>(&error) != nullptr) throw;
    }
    if (simulator_ == nullptr && !kept(at)) try {
        simulate(at, false, unwanted);
      } catch (const std::exception& error) {
        drop_simulator(error);
        throw;
      }
    if (!kept(at)) return {};
  }
  last_ = assemble(at);
  const std::string messages = validation_messages();
  return {last_, messages, !messages.empty()};
}

void SimulatedTicks::simulate(TickAt at, bool goes_on, const std::function<bool()>& unwanted) {
  make_simulator();
  since_ = WallClock::now();
  if (!leads_to(at)) {
    simulator_->drain(*this);  // it is simulated, and may be asked for
    in_flight_.reset();
    earlier_ms_ = 0.0;
    since_ = WallClock::now();
    sequence_ = at.sequence;
    simulator_->start(at.sequence, at.tick);
  }
  while (!kept(at)) {
    const int64_t tick = simulator_->next_tick();
    if (tick < at.tick && unwanted())
      break;  // only on the way: else nothing would be shown while somebody scrubs
    const bool recorded = tick > at.tick;
    GREATX_CHECK(!recorded || in_flight_, "tick {} of sequence {} is not due", at.tick, at.sequence);
    if (recorded && !goes_on) {
      simulator_->drain(*this);
      in_flight_.reset();
    } else {
      in_flight_ = simulator_->step(*this) ? std::optional(tick) : std::nullopt;
    }
  }
  earlier_ms_ += std::chrono::duration<double, std::milli>(WallClock::now() - since_).count();
}

void SimulatedTicks::write(Packet packet) {
  const WallClock::time_point now = WallClock::now();
  const double milliseconds =
      std::exchange(earlier_ms_, 0.0) + std::chrono::duration<double, std::milli>(now - since_).count();
  since_ = now;
  const auto times = std::make_shared<const sim::TickTimes>(simulator_->times());
  store_.begin_turn();
  for (Record& record : packet.records)
    store_.put(sequence_, {std::make_shared<const Record>(std::move(record)), milliseconds, times});
}

std::shared_ptr<const ShownTick> SimulatedTicks::assemble(TickAt at) {
  auto shown = std::make_shared<ShownTick>();
  shown->sequence = at.sequence;
  shown->packet.tick = at.tick;
  shown->packet.time_ns = sim::Clock(experiment_->scenario.tick_rate_hz).nanoseconds(at.tick);
  for (uint32_t sensor = 0; sensor < info_->sensors.size(); ++sensor) {
    const int64_t tick = schedule_->last_of(sensor, at.tick);
    RecordStore::Kept newest;
    if (tick >= 0) newest = store_.find(at.sequence, sensor, tick);
    if (newest.record == nullptr && last_ != nullptr && last_->sequence == at.sequence &&
        last_->newest[sensor] != nullptr && last_->newest[sensor]->tick == tick)
      newest.record = last_->newest[sensor];
    if (tick == at.tick) {
      shown->packet.records.push_back(*newest.record);
      shown->simulated_ms = newest.milliseconds;
      shown->times = newest.times;
    }
    shown->newest.push_back(std::move(newest.record));
  }
  shown->memory = memory();
  return shown;
}

RunMemory SimulatedTicks::memory() const {
  RunMemory memory;
  memory.kept_bytes = store_.bytes();
  if (device_ == nullptr) return memory;
  const gpu::MemoryUse use = gpu::memory_use(*device_);
  memory.device_bytes = use.allocated_bytes;
  memory.device_used_bytes = use.used_bytes;
  memory.device_budget_bytes = use.budget_bytes;
  return memory;
}

/// Takes what the validation layer had to say, as one text.
std::string SimulatedTicks::validation_messages() const {
  const std::vector<std::string> messages =
      device_ ? device_->validation_log()->take() : std::vector<std::string>();
  if (messages.empty()) return {};
  return fmt::format("{} validation messages:\n{}", messages.size(), fmt::join(messages, "\n"));
}

class LoopedLiveRun : public Looped<LiveRun> {
 public:
  LoopedLiveRun(LiveOptions options, const std::shared_ptr<Handover>& handover)
      : Looped([options, handover] { return std::make_unique<SimulatedTicks>(options, *handover); },
               !options.paused),
        handover_(handover) {}
  std::shared_ptr<const sim::Experiment> experiment() const override { return handover_->take(); }

 private:
  std::shared_ptr<Handover> handover_;
};

}  // namespace

std::unique_ptr<LiveRun> live_run(LiveOptions options) {
  return std::make_unique<LoopedLiveRun>(std::move(options), std::make_shared<Handover>());
}

}  // namespace greatx::view
