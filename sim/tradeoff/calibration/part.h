// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// The calibration of one modality. Inside of sim/tradeoff/calibration.
#pragma once

#include <limits>
#include <map>
#include <set>

#include "sim/tradeoff/calibration/calibration.h"
#include "sim/tradeoff/calibration/ticks.h"
#include "sim/tradeoff/front.h"

namespace greatx::sim {

inline constexpr double slow_tick_ms = 500.0;        ///< then few ticks are run
inline constexpr double slow_reference_ms = 5000.0;  ///< then few ticks of the reference are run
inline constexpr double least_saving = 0.03;         ///< of a tick; below that, times count as equal

inline double median_of(const SettingResult& result) { return spread_of(result.wall_ms).median; }
inline YamlChange switched(const std::string& effect, bool on) {
  return {YamlChange::Kind::set, {"effects", effect}, on ? "on" : "off"};
}
inline bool is_on(const Experiment& experiment, const std::string& effect) {
  for (const Effect* known : experiment.plan.all())
    if (known->name == effect) return known->on;
  return false;
}

/// What all modalities have in common.
struct CalibrationRun {
  gpu::Device& device;
  const Experiment& whole;
  std::filesystem::path assets;
  std::function<void(const std::string&)> say;
  double most_ms = 0.0;  ///< settings that alone take longer are out: a budget
};

class PartCalibration {
 public:
  /// `targets` are those of the modality, at least one.
  PartCalibration(const CalibrationRun& run, Modality modality, std::vector<AccuracyTarget> targets);

  /// Measures effects and knobs by themselves, and predicts the front.
  void measure_knobs();
  /// Measures joint settings and takes the cheapest one that meets the targets with a margin.
  void choose_cheapest();
  /// Takes the cheapest point of the predicted front whose power is at most `power`; 1 meets the targets.
  void take(double power);
  double predicted_ms() const { return chosen_.ms; }
  double predicted_power() const { return chosen_.power; }
  /// The changes of the choice, for the scenario with all of its sensors.
  std::vector<YamlChange> changes() const;
  /// Runs the choice on ticks that took no part so far. Where it misses a target, more accurate joint
  /// settings take its place, and at last the reference.
  CalibratedPart checked();

 private:
  struct Part;
  /// A knob that takes part, as it was measured.
  struct Free {
    Knob knob;
    FrontKnob front;
    size_t reference = 0;
    std::optional<size_t> own;
    /// Leaves out what takes longer than the scenario's own setting, which becomes the reference.
    void keep_up_to_own(double own_ms);
  };

  /// A joint setting that met the targets on the ticks of the calibration.
  struct Candidate {
    FrontPoint point;
    double power = 0.0;
    std::vector<SensorError> errors;
  };

  CalibratedPart check();
  bool take_more_accurate();
  void find_knobs();
  void measure_effects();
  void drop_effects(const std::vector<FrontSetting>& toggled, const std::vector<double>& ratios);
  void open_up(const std::vector<FrontSetting>& toggled, std::vector<double>& ratios);
  double one_tick_ms(const Experiment& experiment) const;
  bool is_dropped(const std::string& effect) const;
  void measure_numbers();
  void add_number(const Knob& knob);
  void limit_reference();
  RecordedReference recorded(const MeasurePlan& plan) const;
  /// Runs settings on the ticks of the calibration.
  std::vector<SettingResult> measure(const std::vector<Experiment>& settings, size_t reference,
                                     Effort effort) const;
  Experiment with(const std::vector<YamlChange>& changes) const;
  std::vector<YamlChange> reference_changes() const;
  std::vector<YamlChange> changes_of(const std::vector<size_t>& choice) const;
  /// Error over allowed error, as powers; the largest of all targets and sensors. 1 is just allowed.
  double power_of(const std::vector<SensorError>& errors) const;
  double worst(const std::vector<SensorError>& errors, const AccuracyTarget& target) const;

  const CalibrationRun& run_;
  const Modality modality_;
  const std::vector<AccuracyTarget> targets_;
  Experiment base_;  ///< of the modality alone, as the scenario is
  Experiment open_;  ///< the same with the effects on that may matter, but for the late ones
  std::vector<Knob> effects_;
  std::vector<std::string> dropped_;  ///< effects that are off in any choice
  std::vector<std::string> late_;     ///< effects that are too slow to be on while knobs are measured
  double dropped_power_ = 0.0;
  std::vector<KeptKnob> kept_;
  std::vector<Free> free_;
  double own_ms_ = 0.0;        ///< of a tick of open_, the base of the front
  double reference_ms_ = 0.0;  ///< of a tick of the reference, predicted
  Effort effort_ = Effort::joint;
  std::set<std::vector<size_t>> tried_;
  std::optional<RecordedReference> check_reference_;  ///< on the ticks that check the choice
  std::vector<FrontPoint> front_;
  FrontPoint chosen_;
  bool finest_ = false;        ///< the choice is the reference
  double chosen_power_ = 0.0;  ///< measured
  std::vector<SensorError> calibrated_;
  std::vector<Candidate> candidates_;
};

}  // namespace greatx::sim
