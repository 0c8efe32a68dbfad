// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Measures what each effect of a scenario costs and changes here: every effect by itself is switched off if
// it is on, and on if it is off.
#pragma once

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "gpu/device.h"
#include "sim/experiment/experiment.h"
#include "sim/tradeoff/knob.h"
#include "sim/tradeoff/measure.h"

namespace greatx::sim {

/// What an effect changes in the records of one modality.
struct EffectChange {
  std::string effect;
  Modality modality = Modality::csi;
  bool on = false;             ///< as the scenario has it
  std::string unmeasured;      ///< why there are no figures: nothing to act on, refused; empty: there are
  Spread own_ms, switched_ms;  ///< of ticks of the modality alone, in turns
  bool exact = true;           ///< equal bytes either way
  /// Of the records with the effect switched against those of the scenario as it is; the worst sensor's.
  std::vector<ErrorFigure> figures;
};

/// Returns the switchable effects of every modality of the scenario. Those of radars are measured without
/// noise, except noise itself. `say` takes lines of progress, or an empty text, and may throw to stop.
std::vector<EffectChange> measure_effects(gpu::Device& device, const Experiment& experiment,
                                          const std::filesystem::path& assets,
                                          const std::function<void(const std::string&)>& say);

/// Time of one pass on the device, or of one activity of the host, per tick.
struct PassTime {
  std::string name;
  bool host = false;
  double count = 0.0;  ///< per tick
  double ms = 0.0;     ///< per tick
};

/// Returns the passes that the whole scenario records in its first ticks after a warm-up, the longest first.
/// A pass that is not recorded is not in the list.
std::vector<PassTime> pass_times(gpu::Device& device, const Experiment& experiment, int64_t ticks);

}  // namespace greatx::sim
