// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "sim/tradeoff/effect_measure.h"

#include <algorithm>
#include <map>

#include <fmt/format.h>

#include "core/error.h"
#include "sim/run/simulator.h"

namespace greatx::sim {

namespace {

bool is_on(const Experiment& experiment, const std::string& effect) {
  for (const Effect* known : experiment.plan.all())
    if (known->name == effect) return known->on;
  return false;
}

/// Of figures of several sensors, the largest value of each name.
std::vector<ErrorFigure> worst_of(const std::vector<SensorError>& errors) {
  std::vector<ErrorFigure> figures;
  for (const SensorError& error : errors) {
    const auto same = std::ranges::find(figures, error.figure.name, &ErrorFigure::name);
    if (same == figures.end())
      figures.push_back(error.figure);
    else if (error.figure.value > same->value)
      *same = error.figure;
  }
  return figures;
}

/// Drops what a sink is given.
class Nowhere : public RecordSink {
 public:
  void write(Packet) override {}
};

/// One modality of the scenario, and the device that runs it.
struct ModalityRun {
  gpu::Device& device;
  const Experiment& whole;
  const std::filesystem::path& assets;
  const std::function<void(const std::string&)>& say;
  Modality modality;
  Experiment experiment;
};

/// Measures effects that share a context, each switched by itself.
void measure_group(const ModalityRun& part, const std::vector<Knob>& knobs,
                   std::vector<EffectChange>& changes) {
  const Experiment base =
      experiment_with(part.experiment, knobs.front().context_changes, part.whole, part.assets);
  std::vector<Experiment> settings{base};
  std::vector<EffectChange> group;
  for (const Knob& knob : knobs) {
    EffectChange change;
    change.effect = knob.name;
    change.modality = part.modality;
    change.on = is_on(base, knob.name);
    change.unmeasured = knob.skipped;
    if (knob.skipped.empty()) try {
        const Setting& other = knob.settings[change.on ? 0 : 1];
        Experiment switched = experiment_with(base, other.changes, part.whole, part.assets);
        if (same_effects(switched.plan, base.plan))
          change.unmeasured = "nothing to act on";
        else
          settings.push_back(std::move(switched));
      } catch (const UserError& error) {
        change.unmeasured = error.what();
      }
    (change.unmeasured.empty() ? group : changes).push_back(change);
  }
  if (group.empty()) return;
  part.say(fmt::format("{}: {} effects, one by one", name_of(part.modality), group.size()));
  const std::vector<SettingResult> results =
      measure_settings(part.device, settings, 0, kind_of(part.modality), plan_blocks(base.scenario, 2, 2),
                       [&](double) { part.say({}); });
  for (size_t i = 0; i < group.size(); ++i) {
    group[i].own_ms = spread_of(results[0].wall_ms);
    group[i].switched_ms = spread_of(results[i + 1].wall_ms);
    group[i].exact = results[i + 1].exact;
    group[i].figures = worst_of(results[i + 1].errors);
    changes.push_back(std::move(group[i]));
  }
}

}  // namespace

std::vector<EffectChange> measure_effects(gpu::Device& device, const Experiment& experiment,
                                          const std::filesystem::path& assets,
                                          const std::function<void(const std::string&)>& say) {
  std::vector<EffectChange> changes;
  for (const Modality modality : all_modalities) {
    std::optional<Scenario> scenario = alone(experiment.scenario, modality, assets);
    if (!scenario) continue;
    const ModalityRun part{device, experiment, assets,
                           say,    modality,   make_experiment(std::move(*scenario), experiment)};
    std::map<std::string, std::vector<Knob>> groups;
    for (Knob& knob : knobs_of(part.experiment, modality, false))
      if (is_effect(knob)) groups[knob.context].push_back(std::move(knob));
    for (const auto& [context, knobs] : groups) measure_group(part, knobs, changes);
  }
  return changes;
}

std::vector<PassTime> pass_times(gpu::Device& device, const Experiment& experiment, int64_t ticks) {
  Simulator simulator(device, experiment);
  Nowhere nowhere;
  simulator.start(0);
  simulator.keep_pass_samples(true);
  const auto run = [&](int64_t count) {
    for (int64_t i = 0; i < count; ++i)
      if (!simulator.step(nowhere)) break;
    simulator.drain(nowhere);
  };
  run(1);
  const RunStatistics before = simulator.statistics();
  run(ticks);
  const RunStatistics after = simulator.statistics();
  const double ran = static_cast<double>(std::max<int64_t>(after.ticks - before.ticks, 1));
  std::vector<PassTime> times;
  const auto add = [&](const std::map<std::string, PassTotal>& totals,
                       const std::map<std::string, PassTotal>& earlier, bool host) {
    for (const auto& [name, total] : totals) {
      const auto first = earlier.find(name);
      const PassTotal none, &from = first == earlier.end() ? none : first->second;
      if (total.count == from.count) continue;
      times.push_back({name, host, static_cast<double>(total.count - from.count) / ran,
                       (total.milliseconds - from.milliseconds) / ran});
    }
  };
  add(after.passes, before.passes, false);
  add(after.host, before.host, true);
  std::ranges::stable_sort(times, std::greater(), &PassTime::ms);
  return times;
}

}  // namespace greatx::sim
