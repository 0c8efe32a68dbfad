// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Chooses settings for a scenario that says which errors it allows (`accuracy:`) or how long a tick may take
// (`time_budget_ms_per_tick:`) instead of giving settings. Data flows one way, for each modality:
//
//   Experiment ─► effects, one by one ─► knobs, one by one ─► predicted front ─► joint settings
//              ─► a check on other ticks ─► CalibratedPart ─► the scenario with the choice
//
// The reference of a modality has the effects on that the scenario has and those whose own change is more
// than a part of the allowed error. Every knob is at its finest setting that takes at most ten times as long
// as the scenario's own one, which stays if its error is at most 2 % of the allowed power. A knob that the
// scenario writes stays as written: it is a part of what is asked for.
#pragma once

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "core/fields/edit_yaml.h"
#include "gpu/device.h"
#include "sim/experiment/experiment.h"
#include "sim/tradeoff/knob.h"
#include "sim/tradeoff/measure.h"

namespace greatx::sim {

/// A knob that takes another setting than it has by default.
struct ChosenSetting {
  std::string knob, own, chosen;  ///< own: empty if it is none of the knob's settings
};

/// A knob that takes no part, and why.
struct KeptKnob {
  std::string knob, why;
};

struct TargetOutcome {
  AccuracyTarget target;
  /// Errors against the reference, of the worst sensor, on the ticks of the calibration and on others. NaN:
  /// there was nothing to compare, no tick was left, or the choice is a predicted one (a time budget).
  double calibrated = 0.0, validated = 0.0;
  double own = 0.0;  ///< of the scenario as it is without the choice, on the ticks of `validated`
};

/// Holds the choice for one modality.
struct CalibratedPart {
  Modality modality = Modality::csi;
  std::vector<ChosenSetting> chosen;
  std::vector<KeptKnob> kept;
  std::vector<TargetOutcome> outcomes;
  bool finest = false;  ///< no joint setting but the reference met the targets with a margin
  /// All figures on the ticks that check the promise: a choice may change what no target speaks of.
  std::vector<SensorError> errors;
  std::vector<YamlChange> changes;            ///< of the scenario with all of its sensors
  std::string reference;                      ///< in words: the knobs' settings
  std::vector<YamlChange> reference_changes;  ///< of the scenario with all of its sensors
  /// Times of ticks of the modality alone, measured in turns on the ticks that check the promise: with the
  /// choice, as the scenario is without it, and of the reference.
  Spread chosen_ms, own_ms, reference_ms;
  /// Ticks that took no part in the choice, and those of them at which every target was met.
  int64_t checked_ticks = 0, met_ticks = 0;
};

struct Calibration {
  std::vector<CalibratedPart> parts;  ///< of the modalities that were calibrated
  double budget_ms = 0.0;             ///< 0: none
  Spread tick_ms;                     ///< of the whole scenario with the choice; only with a budget
  std::string text;                   ///< the scenario with the choice, without its wishes
};

/// Chooses settings. `say` takes a line of progress from time to time and may throw to stop. Throws UserError
/// if no sensor delivers what a target speaks of, if no setting meets the time budget, and what the simulator
/// throws.
Calibration calibrate(gpu::Device& device, const Experiment& experiment, const std::filesystem::path& assets,
                      const std::function<void(const std::string&)>& say);

/// Returns the share of ticks that meet the targets at least, with 95 % confidence, if `met` of `checked`
/// independent ticks did (Clopper and Pearson, Biometrika 26, 1934, one-sided). 0 if none was checked.
double least_share(int64_t met, int64_t checked);

}  // namespace greatx::sim
