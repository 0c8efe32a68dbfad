// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// The effects of a modality: which of them matter, and with which of them the knobs are measured.
#include <algorithm>
#include <utility>

#include <fmt/format.h>

#include "sim/tradeoff/calibration/part.h"
#include "sim/tradeoff/calibration/wishes.h"

namespace greatx::sim {

namespace {

constexpr double dropped_share = 0.1;  ///< of the allowed power that effects may take which go first
constexpr double late_ms = 3000.0;     ///< of a tick: an effect that makes it longer is late,
constexpr double late_factor = 2.0;    ///< if it makes it so many times as long

}  // namespace

void PartCalibration::find_knobs() {
  std::vector<YamlChange> on;
  for (const Knob& knob : knobs_of(base_, modality_, modality_ != Modality::events)) {
    const std::string why = why_kept(knob, base_, run_.whole.scenario, modality_);
    if (!why.empty()) {
      kept_.push_back({knob.name, why});
      continue;
    }
    if (!is_effect(knob)) continue;
    effects_.push_back(knob);
    on.push_back(switched(knob.name, true));
  }
  // What is switched on in vain has nothing to act on.
  const Experiment open = with(on);
  std::erase_if(effects_, [&](const Knob& knob) { return !is_on(open, knob.name); });
}

/// Each effect is switched by itself, from the scenario's own settings: on if it is off, and the other way
/// round.
void PartCalibration::measure_effects() {
  std::vector<Experiment> settings{base_};
  std::vector<Knob> able;
  for (const Knob& knob : effects_) try {
      settings.push_back(with({switched(knob.name, !is_on(base_, knob.name))}));
      able.push_back(knob);
    } catch (const UserError&) {  // another setting needs it as it is
    }
  effects_ = std::move(able);
  const std::vector<SettingResult> results = measure(settings, 0, Effort::singles);
  own_ms_ = median_of(results[0]);
  check_figures(results[0], targets_, run_.whole.scenario);
  std::vector<FrontSetting> toggled;
  for (size_t i = 0; i < effects_.size(); ++i)
    toggled.push_back({median_of(results[i + 1]), power_of(results[i + 1].errors)});
  std::vector<double> ratios;  // of a tick with the effect to one without it
  for (size_t i = 0; i < effects_.size(); ++i)
    ratios.push_back(is_on(base_, effects_[i].name) ? own_ms_ / toggled[i].ms : toggled[i].ms / own_ms_);
  drop_effects(toggled, ratios);
  open_up(toggled, ratios);
  for (size_t i = 0; i < effects_.size(); ++i) {
    // What costs nothing stays on.
    if (is_dropped(effects_[i].name) || ratios[i] < 1.0 / (1.0 - least_saving)) continue;
    free_.push_back({effects_[i], {}, 1, 1});
    const bool late = std::ranges::find(late_, effects_[i].name) != late_.end();
    const double off_ms = late ? own_ms_ : own_ms_ / ratios[i], on_ms = late ? own_ms_ * ratios[i] : own_ms_;
    free_.back().front.settings = {{off_ms, toggled[i].power}, {on_ms, 0.0}};
  }
}

/// Decides which effects may be on. Those that hardly matter go first, so that the knobs are measured without
/// their time: an effect that is off stays off, and one that is on goes off if that saves time.
void PartCalibration::drop_effects(const std::vector<FrontSetting>& toggled,
                                   const std::vector<double>& ratios) {
  std::vector<size_t> order(toggled.size());
  for (size_t i = 0; i < order.size(); ++i) order[i] = i;
  std::ranges::stable_sort(order, {}, [&](size_t i) { return toggled[i].power; });
  for (const size_t i : order) {
    const std::string& name = effects_[i].name;
    const bool own_on = is_on(base_, name);
    if (!own_on && toggled[i].ms > run_.most_ms) {
      dropped_.push_back(name);
      kept_.push_back({name, fmt::format("it alone takes {:.3g} ms", toggled[i].ms)});
      continue;
    }
    const bool saves = ratios[i] > 1.0 / (1.0 - least_saving);
    if (dropped_power_ + toggled[i].power > dropped_share || (own_on && !saves)) continue;
    dropped_power_ += toggled[i].power;
    dropped_.push_back(name);
  }
}

/// Switches effects on together, the most important one first, as long as a tick stays short. The knobs are
/// measured with these. The others are late: they are on in the reference alone, and their `ratios` become
/// those to the tick without them.
void PartCalibration::open_up(const std::vector<FrontSetting>& toggled, std::vector<double>& ratios) {
  std::vector<YamlChange> changes;
  std::vector<size_t> order;
  for (size_t i = 0; i < effects_.size(); ++i) {
    if (is_dropped(effects_[i].name))
      changes.push_back(switched(effects_[i].name, false));
    else if (!is_on(base_, effects_[i].name))
      order.push_back(i);
  }
  std::ranges::stable_sort(order, std::greater(), [&](size_t i) { return toggled[i].power; });
  open_ = with(changes);
  own_ms_ = one_tick_ms(open_);
  for (const size_t i : order) {
    std::vector<YamlChange> more = changes;
    more.push_back(switched(effects_[i].name, true));
    Experiment experiment = with(more);
    run_.say(fmt::format("{}: {} beside the other effects", name_of(modality_), effects_[i].name));
    const double ms = one_tick_ms(experiment);
    if (ms > late_ms && ms > late_factor * own_ms_) {
      late_.push_back(effects_[i].name);
      ratios[i] = ms / own_ms_;
      continue;
    }
    changes = std::move(more);
    open_ = std::move(experiment);
    own_ms_ = ms;
  }
}

/// Returns the time of a tick after one of warm-up, or of the first tick if ticks are slow.
double PartCalibration::one_tick_ms(const Experiment& experiment) const {
  MeasurePlan plan = plan_blocks(base_.scenario, 1, 1);
  if (own_ms_ > slow_tick_ms) plan.warm_up = 0;
  const RecordedReference tick =
      record_reference(run_.device, experiment, plan, [this](double) { run_.say({}); });
  return spread_of(tick.wall_ms).median;
}

}  // namespace greatx::sim
