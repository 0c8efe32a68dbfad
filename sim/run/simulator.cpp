// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "sim/run/simulator.h"

#include <algorithm>
#include <chrono>
#include <optional>
#include <utility>

#include "core/activity.h"
#include "core/watch.h"
#include "sim/plan/plan_options.h"
#include "sim/sensors/located.h"

namespace greatx::sim {

namespace {

constexpr VkDeviceSize first_upload_bytes = 4u << 20, first_readback_bytes = 16u << 20;

}  // namespace

/// Describes a tick that is recorded and not yet collected.
struct Simulator::InFlight {
  const gpu::TickSlot* slot = nullptr;
  int64_t tick = 0;
  std::vector<Due> due;
  TickTimes times;
  /// The sensors that recorded scopes, in order, each with the number of scopes until it ended. Kept for
  /// `times` alone.
  std::vector<std::pair<uint32_t, uint64_t>> recorded;
};

/// Measures the wall time of its lifetime: for a row of RunStatistics::host if samples are kept, and for a
/// row of the tick's times if those are kept.
class Simulator::HostScope {
 public:
  HostScope(Simulator& simulator, TickTimes* times, const char* doing, uint32_t sensor = TimeRow::shared)
      : times_(simulator.keep_times_ ? times : nullptr), doing_(doing), sensor_(sensor) {
    if (simulator.keep_samples_)
      total_ = &simulator.statistics_
                    .host[sensor == TimeRow::shared ? doing : doing + (" " + simulator.specs_[sensor].name)];
    if (total_ != nullptr || times_ != nullptr) begin_ = std::chrono::steady_clock::now();
  }
  ~HostScope() {
    if (total_ == nullptr && times_ == nullptr) return;
    const double milliseconds =
        std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - begin_).count();
    if (times_ != nullptr) times_->rows.push_back({doing_, sensor_, false, 1, milliseconds});
    if (total_ == nullptr) return;
    ++total_->count;
    total_->milliseconds += milliseconds;
    total_->samples.push_back(milliseconds);
  }
  HostScope(const HostScope&) = delete;
  HostScope& operator=(const HostScope&) = delete;

 private:
  PassTotal* total_ = nullptr;
  TickTimes* times_;
  const char* doing_;
  uint32_t sensor_;
  std::chrono::steady_clock::time_point begin_;
};

Simulator::Simulator(gpu::Device& device, const Experiment& experiment)
    : scenario_(experiment.scenario),
      world_(*experiment.world),
      device_(device),
      radio_(std::make_unique<RadioAhead>(device, experiment)),
      gpu_scene_(device, world_.scene, gpu_scene_options(experiment.plan)),
      ring_(device, slots_in_flight, first_upload_bytes, first_readback_bytes),
      clock_(scenario_.tick_rate_hz),
      schedule_(scenario_.tick_rate_hz),
      passes_(radio_->begin_radars(gpu_scene_), experiment),
      sensors_(make_sensors({gpu_scene_, passes_, experiment, *radio_})),
      comparer_(world_, experiment.plan.consistency.on),
      places_(scenario_, world_) {
  radio_.reset();
  statistics_.warnings = scenario_.warnings;
  for (const RunSensor& run : sensors_) {
    schedule_.add(run.rate_hz);
    specs_.push_back(run.sensor->spec());
    looks_ahead_ |= run.sensor->looks_ahead();
  }
}

Simulator::~Simulator() = default;

void Simulator::start(uint32_t sequence, int64_t first_tick) {
  TickTimes started;
  {
    std::optional<HostScope> scope;
    if (keep_times_) scope.emplace(*this, &started, "start");
    start_sequence(sequence, first_tick);
  }
  start_ms_ = started.rows.empty() ? 0.0 : started.rows.front().milliseconds;
}

void Simulator::start_sequence(uint32_t sequence, int64_t first_tick) {
  GREATX_CHECK(pending_ == nullptr, "sequence {} started with a tick in flight", sequence);
  sequence_ = sequence;
  courses_ = make_courses(scenario_, world_, sequence);
  for (size_t node = 0; node < courses_.draws.size(); ++node)
    if (clearance_of(scenario_.nodes[node]) > 0.0)
      draws_[scenario_.nodes[node].name + ".trajectory_draws"] += courses_.draws[node];
  due_ticks_ = 0;
  for (next_tick_ = schedule_.next(0, scenario_.ticks); next_tick_ < std::min(first_tick, scenario_.ticks);
       ++due_ticks_)
    next_tick_ = schedule_.next(next_tick_ + 1, scenario_.ticks);
  if (next_tick_ >= scenario_.ticks) return;
  const Moment moment = moment_at(next_tick_), beginning = moment_at(0);
  for (const RunSensor& run : sensors_)
    located(run.where,
            [&] { run.sensor->start(run.sensor->remembers() ? beginning.context : moment.context); });
  replay(next_tick_);
}

bool Simulator::remembers() const {
  return std::ranges::any_of(sensors_, [](const RunSensor& run) { return run.sensor->remembers(); });
}

/// Runs the sensors that remember through the ticks before `end`, without writing anything.
void Simulator::replay(int64_t end) {
  if (!remembers()) return;
  WorkStage stage("catching up");
  stage.expect(static_cast<double>(due_ticks_));
  int64_t before = 0;
  for (int64_t tick = schedule_.next(0, end); tick < end; tick = schedule_.next(tick + 1, end)) {
    checkpoint();
    stage.add(1);
    std::vector<Due> due = schedule_.due(tick, before++);
    std::erase_if(due, [&](const Due& d) { return !sensors_[d.sensor].sensor->remembers(); });
    if (due.empty()) continue;
    gpu::TickSlot& slot = ring_.begin();
    InFlight in_flight{&slot, tick, std::move(due), {}, {}};
    record(in_flight, slot, moment_at(tick));
    ring_.submit(slot, gpu::TickRing::Kind::setup);
    ring_.wait(slot);
    for (const Due& d : in_flight.due) sensors_[d.sensor].sensor->catch_up(slot);
  }
}

Moment Simulator::moment_at(int64_t tick) const {
  Moment moment = sim::moment_at(world_, courses_, clock_, tick, schedule_.previous(tick));
  moment.context.sequence = sequence_;
  return moment;
}

bool Simulator::step(RecordSink& sink) {
  if (next_tick_ >= scenario_.ticks) {
    drain(sink);
    return false;
  }
  if (looks_ahead_ && pending_ != nullptr) {
    const HostScope scope(*this, &pending_->times, "wait to look ahead");
    ring_.wait(*pending_->slot);
  }
  const int64_t tick = next_tick_;
  gpu::TickSlot& slot = ring_.begin();
  auto in_flight = std::make_unique<InFlight>();
  in_flight->slot = &slot;
  in_flight->tick = tick;
  in_flight->due = schedule_.due(tick, due_ticks_++);
  in_flight->times.start_ms = std::exchange(start_ms_, 0.0);
  const Moment moment = moment_at(tick);
  for (const Due& due : in_flight->due) places_.look(specs_[due.sensor].name, moment.context);
  record(*in_flight, slot, moment);
  next_tick_ = schedule_.next(tick + 1, scenario_.ticks);
  if (looks_ahead_ && next_tick_ < scenario_.ticks) record_ahead(*in_flight, slot);
  ring_.submit(slot);
  ++statistics_.ticks;

  drain(sink);  // collects the tick before, while the GPU works on this one
  pending_ = std::move(in_flight);
  return true;
}

void Simulator::record(InFlight& in_flight, gpu::TickSlot& slot, const Moment& moment) {
  const Activity activity("recording a tick");
  const uint64_t passes_before = device_.counters().passes;
  const auto note_passes = [&](uint32_t sensor) {
    if (keep_times_) in_flight.recorded.emplace_back(sensor, device_.counters().passes - passes_before);
  };
  {
    const HostScope scope(*this, &in_flight.times, "record");
    const bool pictures = std::ranges::any_of(
        in_flight.due, [&](const Due& d) { return sensors_[d.sensor].sensor->draws_pictures(); });
    if (pictures) set_lamps(gpu_scene_, moment.context, moment.context.time_s);
    gpu_scene_.record_update(slot, moment.bodies);
    if (pictures) passes_.lighting->record(slot, moment.bodies);
    note_passes(TimeRow::shared);
  }
  for (const Due& d : in_flight.due) {
    const RunSensor& run = sensors_[d.sensor];
    const HostScope scope(*this, &in_flight.times, "record", d.sensor);
    located(run.where, [&] { run.sensor->record(slot, moment.context); });
    note_passes(d.sensor);
  }
}

void Simulator::record_ahead(InFlight& in_flight, gpu::TickSlot& slot) {
  const Moment next = moment_at(next_tick_);
  bool updated = false;
  const uint64_t passes_before = device_.counters().passes;
  const uint64_t recorded = in_flight.recorded.empty() ? 0 : in_flight.recorded.back().second;
  for (const Due& due : schedule_.due(next_tick_, due_ticks_)) {
    Sensor& sensor = *sensors_[due.sensor].sensor;
    if (!sensor.looks_ahead()) continue;
    if (!updated) gpu_scene_.record_update(slot, next.bodies);
    updated = true;
    const HostScope scope(*this, &in_flight.times, "look ahead", due.sensor);
    sensor.record_ahead(slot, next.context);
    if (keep_times_)
      in_flight.recorded.emplace_back(due.sensor, recorded + device_.counters().passes - passes_before);
  }
}

void Simulator::drain(RecordSink& sink) {
  if (pending_ == nullptr) return;
  const std::unique_ptr<InFlight> in_flight = std::move(pending_);
  collect(*in_flight, sink);
}

void Simulator::collect(InFlight& in_flight, RecordSink& sink) {
  const Activity activity("collecting a tick");
  {
    const HostScope scope(*this, &in_flight.times, "wait");
    ring_.wait(*in_flight.slot);
  }
  Packet packet{in_flight.tick, clock_.nanoseconds(in_flight.tick), {}};
  for (const Due& due : in_flight.due) {
    const HostScope scope(*this, &in_flight.times, "collect", due.sensor);
    const RunSensor& run = sensors_[due.sensor];
    const auto collect = [&] { return run.sensor->collect(*in_flight.slot); };
    packet.records.push_back(
        {due.sensor, packet.tick, packet.time_ns, due.sample, located(run.where, collect)});
    ++statistics_.records[specs_[due.sensor].name];
  }
  {
    const HostScope scope(*this, &in_flight.times, "compare");
    compare(packet);
  }
  add_passes(in_flight);
  times_ = std::move(in_flight.times);
  const HostScope scope(*this, nullptr, "hand over");
  sink.write(std::move(packet));
  ++statistics_.packets;
}

/// Adds the times of the tick's passes to those of the run and, if they are kept, to those of the tick.
void Simulator::add_passes(InFlight& in_flight) {
  const std::vector<gpu::PassTime> passes = in_flight.slot->timestamps.read();
  for (const gpu::PassTime& pass : passes) {
    PassTotal& total = statistics_.passes[pass.name];
    ++total.count;
    total.milliseconds += pass.milliseconds;
    if (keep_samples_) total.samples.push_back(pass.milliseconds);
  }
  if (!keep_times_) return;
  TickTimes& times = in_flight.times;
  times.simulated_ms = simulated_ms(in_flight.tick);
  times.device_is_a_cpu = device_.info().type == "cpu";
  auto by = in_flight.recorded.begin();
  for (size_t i = 0; i < passes.size(); ++i) {
    while (by != in_flight.recorded.end() && by->second <= i) ++by;
    const uint32_t sensor = by == in_flight.recorded.end() ? TimeRow::shared : by->first;
    const auto same = std::ranges::find_if(times.rows, [&](const TimeRow& row) {
      return row.on_device && row.sensor == sensor && row.name == passes[i].name;
    });
    if (same == times.rows.end()) {
      times.rows.push_back({passes[i].name, sensor, true, 1, passes[i].milliseconds});
    } else {
      ++same->count;
      same->milliseconds += passes[i].milliseconds;
    }
  }
}

/// Returns the simulated time from the due tick before `tick` to it; of the first one, to the next.
double Simulator::simulated_ms(int64_t tick) const {
  int64_t from = schedule_.previous(tick), to = tick;
  if (from < 0) {
    from = tick;
    to = schedule_.next(tick + 1, scenario_.ticks);
  }
  return 1e-6 * static_cast<double>(clock_.nanoseconds(to) - clock_.nanoseconds(from));
}

void Simulator::compare(const Packet& packet) {
  std::vector<Witness> witnesses;
  for (const Record& record : packet.records)
    witnesses.push_back({view_of(specs_[record.sensor], record), sensors_[record.sensor].sensor->evidence()});
  comparer_.compare(sequence_, packet.tick, witnesses);
}

std::string Simulator::tracer_note() const {
  if (gpu_scene_.tracer() == gpu::Tracer::driver) return "driver: rays meet triangles by ray queries";
  const gpu::DeviceInfo& info = gpu_scene_.device().info();
  const std::string why = !info.has_ray_query() ? "the device has no ray queries"
                          : info.best_tracer() == gpu::Tracer::tree
                              ? "the device is a CPU, where they are faster than its ray queries"
                              : "chosen";
  return fmt::format("tree: rays meet triangles in trees of greatx's own ({})", why);
}

RunStatistics Simulator::statistics() const {
  RunStatistics statistics = statistics_;
  if (gpu_scene_.traces()) statistics.notes.emplace_back("tracer", tracer_note());
  statistics.consistency = comparer_.totals();
  statistics.rows = comparer_.rows();
  statistics.counters.insert(draws_.begin(), draws_.end());
  places_.count(statistics.counters);
  places_.warn(statistics.warnings);
  for (const RunSensor& run : sensors_) {
    run.sensor->count(statistics.counters);
    run.sensor->warn(statistics.warnings);
    run.sensor->note(statistics.notes);
  }
  return statistics;
}

}  // namespace greatx::sim
