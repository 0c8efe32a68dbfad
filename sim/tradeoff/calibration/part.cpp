// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "sim/tradeoff/calibration/part.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "core/error.h"
#include "sim/tradeoff/calibration/wishes.h"

namespace greatx::sim {

namespace {

constexpr double margin = 0.5;            ///< of the allowed power that the choice may take: 3 dB
constexpr double converged_share = 0.02;  ///< of the allowed power: a knob's own setting is fine enough
constexpr double most_factor = 10.0;  ///< settings that take longer than so many times the default are out
constexpr double most_reference_ms = 60e3;  ///< of a tick: knobs that make the reference slower stay
constexpr double round_factor = 4.0;        ///< of power between the joint settings of a round
constexpr size_t rounds = 3, of_a_round = 3, slow_rounds = 6;

void append(std::vector<YamlChange>& changes, const std::vector<YamlChange>& more) {
  changes.insert(changes.end(), more.begin(), more.end());
}

}  // namespace

PartCalibration::PartCalibration(const CalibrationRun& run, Modality modality,
                                 std::vector<AccuracyTarget> targets)
    : run_(run),
      modality_(modality),
      targets_(std::move(targets)),
      base_(make_experiment(scenario_to_calibrate(run.whole, modality, run.assets), run.whole)),
      open_(base_) {
  find_knobs();
}

bool PartCalibration::is_dropped(const std::string& effect) const {
  return std::ranges::find(dropped_, effect) != dropped_.end();
}

Experiment PartCalibration::with(const std::vector<YamlChange>& changes) const {
  return experiment_with(base_, changes, run_.whole, run_.assets);
}

std::vector<SettingResult> PartCalibration::measure(const std::vector<Experiment>& settings, size_t reference,
                                                    Effort effort) const {
  if (own_ms_ > slow_tick_ms) effort = Effort::slow;
  return measure_settings(run_.device, settings, reference, kind_of(modality_),
                          calibration_ticks(base_.scenario, effort), [this](double) { run_.say({}); });
}

double PartCalibration::worst(const std::vector<SensorError>& errors, const AccuracyTarget& target) const {
  double worst = std::numeric_limits<double>::quiet_NaN();
  for (const SensorError& error : errors)
    if (error.figure.name == target.kind->figure && !(error.figure.value <= worst))
      worst = error.figure.value;
  return worst;
}

double PartCalibration::power_of(const std::vector<SensorError>& errors) const {
  double power = 0.0;
  for (const AccuracyTarget& target : targets_) {
    const bool db = relative_db(target.kind->figure);
    const double error = worst(errors, target);
    if (!std::isnan(error)) power = std::max(power, error_power(error, db) / error_power(target.value, db));
  }
  return power;
}

void PartCalibration::measure_knobs() {
  run_.say(fmt::format("{}: {} effects, one by one", name_of(modality_), effects_.size()));
  measure_effects();
  measure_numbers();
  limit_reference();
  std::vector<FrontKnob> knobs;
  for (const Free& free : free_) knobs.push_back(free.front);
  front_ = front_of(own_ms_, knobs);
  for (FrontPoint& point : front_) point.power += dropped_power_;
  chosen_ = front_.back();
}

void PartCalibration::measure_numbers() {
  std::vector<Knob> numbers;
  for (const Knob& knob : knobs_of(open_, modality_, modality_ != Modality::events))
    if (!is_effect(knob) && why_kept(knob, base_, run_.whole.scenario, modality_).empty())
      numbers.push_back(knob);
  for (size_t k = 0; k < numbers.size(); ++k) {
    run_.say(
        fmt::format("{}: knob {} of {}, {}", name_of(modality_), k + 1, numbers.size(), numbers[k].name));
    add_number(numbers[k]);
  }
}

void PartCalibration::add_number(const Knob& given) {
  Knob knob = given;
  if (!knob.standard) {
    knob.settings.insert(knob.settings.begin(), Setting{"as it is", {}, {}});
    ++knob.reference;
    knob.standard = 0;
  }
  KnobResult measured;
  try {
    measured =
        measure_knob(open_, knob, run_.whole, run_.assets, [this](const auto& settings, size_t reference) {
          return measure(settings, reference, Effort::singles);
        });
  } catch (const UserError& error) {
    kept_.push_back({knob.name, fmt::format("cannot be set here: {}", error.what())});
    return;
  }
  if (*knob.standard >= measured.results.size()) return;
  const double own = median_of(measured.results[*knob.standard]);
  // Finer settings than the scenario's own one are out if its error is a small part of what is allowed.
  const bool converged = power_of(measured.results[*knob.standard].errors) <= converged_share;
  Free free{knob, {}, 0, 0};
  free.knob.settings.clear();
  bool matters = false;
  for (size_t i = 0; i < measured.results.size(); ++i) {
    double ratio = median_of(measured.results[i]) / own;
    if (i != *knob.standard && ratio > (converged ? 1.0 : most_factor)) continue;
    if (i != *knob.standard && ratio > 1.0 && ratio * own > run_.most_ms) continue;
    if (std::abs(ratio - 1.0) < least_saving) ratio = 1.0;
    const double power = power_of(measured.results[i].errors);
    matters |= ratio < 1.0 || power > 0.0;
    if (i == *knob.standard) free.own = free.knob.settings.size();
    if (i == measured.reference && !converged) free.reference = free.knob.settings.size();
    free.knob.settings.push_back(knob.settings[i]);
    // Of equal settings the scenario's own one is taken.
    free.front.settings.push_back({own_ms_ * ratio * (i == *knob.standard ? 1.0 : 1.0 + 1e-6), power});
  }
  if (converged) free.reference = *free.own;
  if (free.reference == 0) free.reference = free.knob.settings.size() - 1;
  if (matters) free_.push_back(std::move(free));
}

std::vector<YamlChange> PartCalibration::reference_changes() const {
  std::vector<YamlChange> changes;
  for (const Knob& effect : effects_)
    if (!is_on(base_, effect.name) && !is_dropped(effect.name))
      changes.push_back(switched(effect.name, true));
  for (const Free& free : free_)
    if (!is_effect(free.knob)) append(changes, free.knob.settings[free.reference].changes);
  return changes;
}

std::vector<YamlChange> PartCalibration::changes_of(const std::vector<size_t>& choice) const {
  std::vector<YamlChange> changes;
  for (const Knob& effect : effects_) {
    bool on = !is_dropped(effect.name);
    for (size_t k = 0; k < free_.size(); ++k)
      if (free_[k].knob.name == effect.name) on = choice[k] == 1;
    if (on != is_on(base_, effect.name)) changes.push_back(switched(effect.name, on));
  }
  for (size_t k = 0; k < free_.size(); ++k)
    if (!is_effect(free_[k].knob) && choice[k] != *free_[k].own)
      append(changes, free_[k].knob.settings[choice[k]].changes);
  return changes;
}

void PartCalibration::take(double power) {
  for (const FrontPoint& point : front_) {
    chosen_ = point;
    if (point.power <= power) return;
  }
}

/// Leaves finer settings of knobs out, the slowest first, until a tick of the reference is short enough.
void PartCalibration::limit_reference() {
  for (;;) {
    double ms = own_ms_;
    Free* slowest = nullptr;
    double most = 1.0;
    for (Free& free : free_) {
      const double ratio = free.front.settings[free.reference].ms / own_ms_;
      ms *= std::max(ratio, 1.0);
      if (is_effect(free.knob) || ratio <= std::max(most, 1.0 + least_saving)) continue;
      most = ratio;
      slowest = &free;
    }
    reference_ms_ = ms;
    if (ms <= most_reference_ms || slowest == nullptr) return;
    kept_.push_back({slowest->knob.name, "settings finer than the scenario's own take too long together"});
    slowest->keep_up_to_own(own_ms_);
  }
}

void PartCalibration::Free::keep_up_to_own(double own_ms) {
  std::vector<Setting> settings;
  std::vector<FrontSetting> points;
  for (size_t i = 0; i < front.settings.size(); ++i) {
    if (i != *own && front.settings[i].ms > (1.0 + least_saving) * own_ms) continue;
    if (i == *own) reference = settings.size();
    settings.push_back(knob.settings[i]);
    points.push_back(front.settings[i]);
  }
  own = reference;
  knob.settings = std::move(settings);
  front.settings = std::move(points);
}

RecordedReference PartCalibration::recorded(const MeasurePlan& plan) const {
  return record_reference(run_.device, with(reference_changes()), plan, [this](double) { run_.say({}); });
}

void PartCalibration::choose_cheapest() {
  const bool slow = reference_ms_ > slow_reference_ms;
  effort_ = slow ? Effort::slow : own_ms_ > slow_tick_ms ? Effort::singles : Effort::joint;
  run_.say(fmt::format("{}: the reference", name_of(modality_)));
  const RecordedReference reference = recorded(calibration_ticks(base_.scenario, effort_));
  double best_ms = std::numeric_limits<double>::infinity(), level = round_factor;
  // Settings that take long are run one after the other, from the fastest one, until one meets the targets.
  const size_t at_once = slow ? 1 : of_a_round, most_rounds = slow ? slow_rounds : rounds;
  for (size_t round = 0; round < most_rounds; ++round) {
    run_.say(fmt::format("{}: joint settings, round {}", name_of(modality_), round + 1));
    std::vector<Experiment> settings;
    std::vector<FrontPoint> points;
    for (size_t i = 0; i < at_once; ++i, level /= round_factor) {
      take(level);
      if (tried_.contains(chosen_.choice)) continue;
      try {
        settings.push_back(with(changes_of(chosen_.choice)));
        points.push_back(chosen_);
        tried_.insert(chosen_.choice);
      } catch (const UserError&) {  // settings that exclude each other
      }
    }
    if (points.empty()) continue;
    const std::vector<SettingResult> results = measure_settings(
        run_.device, settings, reference, kind_of(modality_), [this](double) { run_.say({}); });
    size_t met = 0;
    for (size_t i = 0; i < points.size(); ++i) {
      const SettingResult& result = results[i];
      const double power = power_of(result.errors);
      if (power > margin) continue;
      ++met;
      candidates_.push_back({points[i], power, result.errors});
      if (median_of(result) >= best_ms) continue;
      best_ms = median_of(result);
      chosen_ = points[i];
      chosen_.ms = best_ms;
      chosen_power_ = power;
      calibrated_ = result.errors;
      finest_ = false;
    }
    if (!std::isfinite(best_ms)) {
      finest_ = true;
      continue;  // more accurate ones
    }
    if (round > 0 || met < points.size()) break;
    // All of them met it: cheaper ones may, too.
    const FrontPoint kept = chosen_;
    level = std::pow(round_factor, double(at_once) + 1.0);
    take(level);
    const bool cheaper = chosen_.choice != points.front().choice;
    chosen_ = kept;
    if (!cheaper) break;
  }
}

std::vector<YamlChange> PartCalibration::changes() const {
  return for_whole(finest_ ? reference_changes() : changes_of(chosen_.choice), base_.scenario,
                   run_.whole.scenario);
}

bool PartCalibration::take_more_accurate() {
  if (finest_) return false;
  const Candidate* next = nullptr;
  for (const Candidate& candidate : candidates_)
    if (candidate.power < chosen_power_ / round_factor && (next == nullptr || candidate.power > next->power))
      next = &candidate;
  finest_ = next == nullptr;
  calibrated_.clear();
  if (finest_) return true;
  chosen_ = next->point;
  chosen_power_ = next->power;
  calibrated_ = next->errors;
  return true;
}

CalibratedPart PartCalibration::checked() {
  for (;;) {
    CalibratedPart part = check();
    const bool missed = std::ranges::any_of(
        part.outcomes, [](const TargetOutcome& outcome) { return outcome.validated > outcome.target.value; });
    // The choice of a time budget is not one of joint settings that were measured: it stays.
    if (!missed || candidates_.empty() || !take_more_accurate()) return part;
    run_.say(fmt::format("{}: it misses a target there; a more accurate one", name_of(modality_)));
  }
}

CalibratedPart PartCalibration::check() {
  CalibratedPart part;
  part.modality = modality_;
  part.kept = kept_;
  part.changes = changes();
  part.reference_changes = for_whole(reference_changes(), base_.scenario, run_.whole.scenario);
  for (const Knob& effect : effects_) {
    bool on = !is_dropped(effect.name);
    for (size_t k = 0; k < free_.size(); ++k)
      if (free_[k].knob.name == effect.name) on = finest_ || chosen_.choice[k] == 1;
    if (finest_ && is_on(base_, effect.name)) on = true;
    if (on != is_on(base_, effect.name))
      part.chosen.push_back({effect.name, on ? "off" : "on", on ? "on" : "off"});
  }
  std::vector<std::string> words;
  for (const Knob& effect : effects_)
    if (is_on(base_, effect.name) || !is_dropped(effect.name)) words.push_back(effect.name + " on");
  for (size_t k = 0; k < free_.size(); ++k) {
    const Free& free = free_[k];
    if (is_effect(free.knob)) continue;
    words.push_back(fmt::format("{} {}", free.knob.name, free.knob.settings[free.reference].label));
    const size_t choice = finest_ ? free.reference : chosen_.choice[k];
    if (choice != *free.own)
      part.chosen.push_back(
          {free.knob.name, free.knob.settings[*free.own].label, free.knob.settings[choice].label});
  }
  part.reference = fmt::format("{}", fmt::join(words, ", "));

  run_.say(fmt::format("{}: the choice on other ticks", name_of(modality_)));
  const std::vector<Experiment> settings{with(finest_ ? reference_changes() : changes_of(chosen_.choice)),
                                         base_};
  const std::optional<MeasurePlan> others =
      check_ticks(base_.scenario, effort_, modality_ == Modality::events);
  if (!check_reference_)
    check_reference_ = recorded(others.value_or(calibration_ticks(base_.scenario, effort_)));
  const std::vector<SettingResult> results = measure_settings(
      run_.device, settings, *check_reference_, kind_of(modality_), [this](double) { run_.say({}); });
  part.chosen_ms = spread_of(results[0].wall_ms);
  part.own_ms = spread_of(results[1].wall_ms);
  part.reference_ms = spread_of(check_reference_->wall_ms);
  for (const AccuracyTarget& target : targets_)
    part.outcomes.push_back(
        {target, worst(calibrated_, target),
         others ? worst(results[0].errors, target) : std::numeric_limits<double>::quiet_NaN(),
         worst(results[1].errors, target)});
  part.finest = finest_;
  part.errors = results[0].errors;
  if (!others) return part;
  for (const std::vector<SensorError>& errors : results[0].tick_errors) {
    ++part.checked_ticks;
    part.met_ticks += power_of(errors) <= 1.0;
  }
  return part;
}

}  // namespace greatx::sim
