// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "sim/tradeoff/measure.h"

#include <algorithm>
#include <memory>

#include "core/error.h"
#include "sim/run/simulator.h"
#include "sim/scenario/sensor_kinds.h"
#include "sim/tradeoff/stopwatch.h"

namespace greatx::sim {

namespace {

/// Keeps the packet of the newest tick.
class Newest : public RecordSink {
 public:
  void write(Packet packet) override { packet_ = std::move(packet); }
  Packet& packet() { return packet_; }

 private:
  Packet packet_;
};

/// One setting with its simulator.
class Runner {
 public:
  Runner(gpu::Device& device, const Experiment& experiment)
      : simulator_(device, experiment), build_ms_(building_.wall_ms()) {}

  void start(int64_t tick, SettingResult& result) {
    const Stopwatch watch;
    simulator_.start(0, tick);
    result.start_ms.push_back(watch.wall_ms());
  }
  /// Returns false if the sequence has ended.
  bool step(SettingResult* timed) {
    const Stopwatch watch;
    const bool ran = simulator_.step(newest_);
    simulator_.drain(newest_);
    if (timed != nullptr && ran) {
      timed->wall_ms.push_back(watch.wall_ms());
      timed->cpu_ms.push_back(watch.cpu_ms());
    }
    return ran;
  }
  const Simulator& simulator() const { return simulator_; }
  Packet& packet() { return newest_.packet(); }
  double build_ms() const { return build_ms_; }

 private:
  const Stopwatch building_;
  Simulator simulator_;
  const double build_ms_;
  Newest newest_;
};

size_t index_of(const std::vector<SensorSpec>& specs, const std::string& name) {
  const auto found = std::ranges::find(specs, name, &SensorSpec::name);
  return static_cast<size_t>(found - specs.begin());
}
const Record* record_of(const Packet& packet, size_t sensor) {
  const auto found = std::ranges::find(packet.records, static_cast<uint32_t>(sensor), &Record::sensor);
  return found == packet.records.end() ? nullptr : &*found;
}

/// Whether all arrays that both have are equal, and none is missing on one side.
bool same_bytes(const SensorSpec& a, const Record& x, const SensorSpec& b, const Record& y) {
  if (a.arrays.size() != b.arrays.size()) return false;
  for (size_t i = 0; i < a.arrays.size(); ++i)
    if (a.arrays[i].name != b.arrays[i].name || x.arrays[i].shape != y.arrays[i].shape ||
        x.arrays[i].bytes != y.arrays[i].bytes)
      return false;
  return true;
}

/// Compares one setting with the reference, tick by tick.
class Judge {
 public:
  Judge(const std::vector<SensorSpec>& reference, const std::vector<SensorSpec>& specs, std::string_view kind)
      : reference_(reference), specs_(specs), kind_(kind) {
    restart();
  }
  /// Forgets what was added.
  void restart() {
    sums_.clear();
    for (const SensorSpec& spec : reference_)
      sums_.push_back(spec.kind == kind_ ? make_error_sum(spec.kind) : nullptr);
  }
  void add(const Packet& reference, const Packet& packet, SettingResult& result) {
    for (size_t i = 0; i < reference_.size(); ++i) {
      if (sums_[i] == nullptr) continue;
      const size_t j = index_of(specs_, reference_[i].name);
      const Record *const x = record_of(reference, i), *const y = record_of(packet, j);
      if (x == nullptr || y == nullptr) continue;
      if (!same_bytes(reference_[i], *x, specs_[j], *y)) result.exact = false;
      sums_[i]->add(reference_[i], *x, specs_[j], *y);
    }
  }
  std::vector<SensorError> errors() const {
    std::vector<SensorError> errors;
    for (size_t i = 0; i < reference_.size(); ++i) {
      if (sums_[i] == nullptr) continue;
      for (const ErrorFigure& figure : sums_[i]->figures()) errors.push_back({reference_[i].name, figure});
    }
    return errors;
  }

 private:
  const std::vector<SensorSpec>&reference_, &specs_;
  std::string_view kind_;
  std::vector<std::unique_ptr<ErrorSum>> sums_;
};

}  // namespace

int64_t ticks_between_records(const Scenario& scenario) {
  double highest_hz = 0.0;
  for (const NodeConfig& node : scenario.nodes)
    for (const SensorConfig& sensor : node.sensors)
      if (sensor_kind(sensor).fires) highest_hz = std::max(highest_hz, sensor.rate_hz.value());
  for (const ChannelConfig& channel : scenario.channels)
    highest_hz = std::max(highest_hz, channel.rate_hz.value());
  if (highest_hz <= 0.0) return 1;
  return std::max<int64_t>(static_cast<int64_t>(scenario.tick_rate_hz.value() / highest_hz), 1);
}

MeasurePlan plan_blocks(const Scenario& scenario, int64_t blocks, int64_t ticks) {
  MeasurePlan plan;
  const int64_t stride = ticks_between_records(scenario);
  const int64_t records = std::max<int64_t>(scenario.ticks / stride, 1);
  plan.ticks = std::clamp<int64_t>(records - plan.warm_up, 1, ticks);
  if (records <= plan.warm_up) plan.warm_up = 0;
  const int64_t length = plan.warm_up + plan.ticks;
  blocks = std::clamp<int64_t>(records / length, 1, blocks);
  plan.starts.clear();
  for (int64_t b = 0; b < blocks; ++b)
    plan.starts.push_back(blocks == 1 ? 0 : stride * (b * (records - length) / (blocks - 1)));
  return plan;
}

namespace {

/// Where the records come from that the others are compared with.
struct ReferenceSource {
  size_t setting = 0;                           ///< one of those that are run
  const RecordedReference* recorded = nullptr;  ///< unless it is null
};

/// Runs settings, which outlive it, tick by tick, each tick under all of them in turns.
class Turns {
 public:
  Turns(gpu::Device& device, const std::vector<Experiment>& settings, MeasurePlan plan,
        std::function<void(double)> progress)
      : plan_(std::move(plan)), progress_(std::move(progress)), results_(settings.size()) {
    for (size_t i = 0; i < settings.size(); ++i) {
      runners_.push_back(std::make_unique<Runner>(device, settings[i]));
      results_[i].build_ms = runners_[i]->build_ms();
      results_[i].specs = runners_[i]->simulator().sensors();
      if (runners_[i]->simulator().remembers()) plan_.starts = {0};
      progress_(0.3 * static_cast<double>(i + 1) / static_cast<double>(settings.size()));
    }
  }
  /// Calls `timed` after each timed tick, when the packets of all settings are there.
  void run(const std::function<void()>& timed) {
    const int64_t length = plan_.warm_up + plan_.ticks;
    size_t timed_ticks = 0;
    for (size_t block = 0; block < plan_.starts.size(); ++block) {
      for (size_t i = 0; i < runners_.size(); ++i) runners_[i]->start(plan_.starts[block], results_[i]);
      for (int64_t tick = 0; tick < length; ++tick) {
        if (!step(block, tick)) break;
        if (tick < plan_.warm_up) continue;
        timed();
        if (++timed_ticks >= 2 && watch_.wall_ms() > plan_.most_ms) return;
      }
    }
  }
  const MeasurePlan& plan() const { return plan_; }
  Packet& packet(size_t setting) { return runners_[setting]->packet(); }
  std::vector<SettingResult>& results() { return results_; }

 private:
  /// Returns false if a sequence has ended.
  bool step(size_t block, int64_t tick) {
    bool ran = true;
    const auto length = static_cast<double>(plan_.warm_up + plan_.ticks);
    // Every second tick goes backwards, so that no setting always follows the same one.
    for (size_t k = 0; k < runners_.size(); ++k) {
      const size_t i = tick % 2 == 0 ? k : runners_.size() - 1 - k;
      ran &= runners_[i]->step(tick >= plan_.warm_up ? &results_[i] : nullptr);
      const double ticks = static_cast<double>(tick) + static_cast<double>(k + 1) / double(runners_.size());
      progress_(0.3 + 0.7 * (static_cast<double>(block) + ticks / length) / double(plan_.starts.size()));
    }
    return ran;
  }

  const Stopwatch watch_;
  MeasurePlan plan_;
  const std::function<void(double)> progress_;
  std::vector<std::unique_ptr<Runner>> runners_;
  std::vector<SettingResult> results_;
};

std::vector<SettingResult> measure(gpu::Device& device, const std::vector<Experiment>& settings,
                                   const ReferenceSource& source, std::string_view kind,
                                   const MeasurePlan& plan, const std::function<void(double)>& progress) {
  Turns turns(device, settings, plan, progress);
  std::vector<SettingResult>& results = turns.results();
  const std::vector<SensorSpec>& specs =
      source.recorded ? source.recorded->specs : results[source.setting].specs;
  std::vector<Judge> judges, tick_judges;
  for (const SettingResult& result : results) {
    judges.emplace_back(specs, result.specs, kind);
    tick_judges.emplace_back(specs, result.specs, kind);
  }
  size_t ticks = 0;
  turns.run([&] {
    const Packet& reference =
        source.recorded ? source.recorded->packets.at(ticks++) : turns.packet(source.setting);
    for (size_t i = 0; i < results.size(); ++i) {
      judges[i].add(reference, turns.packet(i), results[i]);
      if (!plan.each_tick) continue;
      tick_judges[i].restart();
      tick_judges[i].add(reference, turns.packet(i), results[i]);
      results[i].tick_errors.push_back(tick_judges[i].errors());
    }
  });
  for (size_t i = 0; i < results.size(); ++i) {
    results[i].errors = judges[i].errors();
    results[i].last = std::move(turns.packet(i));
  }
  return std::move(results);
}

}  // namespace

std::vector<SettingResult> measure_settings(gpu::Device& device, const std::vector<Experiment>& settings,
                                            size_t reference, std::string_view kind, const MeasurePlan& plan,
                                            const std::function<void(double)>& progress) {
  GREATX_CHECK(reference < settings.size(), "reference {} of {}", reference, settings.size());
  return measure(device, settings, {reference}, kind, plan, progress);
}

RecordedReference record_reference(gpu::Device& device, const Experiment& reference, const MeasurePlan& plan,
                                   const std::function<void(double)>& progress) {
  const std::vector<Experiment> settings{reference};
  Turns turns(device, settings, plan, progress);
  RecordedReference recorded{turns.plan(), turns.results()[0].specs, {}, {}};
  turns.run([&] { recorded.packets.push_back(std::move(turns.packet(0))); });
  recorded.wall_ms = turns.results()[0].wall_ms;
  return recorded;
}

std::vector<SettingResult> measure_settings(gpu::Device& device, const std::vector<Experiment>& settings,
                                            const RecordedReference& reference, std::string_view kind,
                                            const std::function<void(double)>& progress) {
  return measure(device, settings, {0, &reference}, kind, reference.plan, progress);
}

Experiment experiment_with(const Experiment& experiment, const std::vector<YamlChange>& changes,
                           const Experiment& whole, const std::filesystem::path& assets) {
  return make_experiment(changed(experiment.scenario, changes, assets), whole);
}

KnobResult measure_knob(const Experiment& experiment, const Knob& knob, const Experiment& whole,
                        const std::filesystem::path& assets, const MeasureFunction& measure) {
  KnobResult result;
  for (size_t kept = knob.settings.size();;) try {
      std::vector<Experiment> settings;
      for (size_t i = 0; i < kept; ++i) {
        std::vector<YamlChange> changes = knob.context_changes;
        const std::vector<YamlChange>& own = knob.settings[i].changes;
        changes.insert(changes.end(), own.begin(), own.end());
        settings.push_back(experiment_with(experiment, changes, whole, assets));
      }
      result.reference = std::min(knob.reference, kept - 1);
      result.results = measure(settings, result.reference);
      return result;
    } catch (const UserError& error) {
      if (kept <= 2 || knob.reference + 1 != knob.settings.size()) throw;
      result.refused = error.what();
      --kept;
    }
}

Spread spread_of(std::vector<double> samples) {
  Spread spread;
  spread.count = samples.size();
  if (samples.empty()) return spread;
  std::ranges::sort(samples);
  const auto at = [&](double share) {
    const double place = share * static_cast<double>(samples.size() - 1);
    const auto below = static_cast<size_t>(place);
    const size_t above = std::min(below + 1, samples.size() - 1);
    return samples[below] + (place - static_cast<double>(below)) * (samples[above] - samples[below]);
  };
  spread.median = at(0.5);
  spread.low = at(0.25);
  spread.high = at(0.75);
  return spread;
}

}  // namespace greatx::sim
