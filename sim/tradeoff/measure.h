// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Measures settings of one knob in turns: each tick is run under every setting before the next one, so that
// a machine that becomes slower does so for all of them. A tick is run alone, without its neighbours beside
// it: it is submitted, and the host waits for it and collects it.
#pragma once

#include <functional>
#include <limits>
#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "core/record.h"
#include "gpu/device.h"
#include "sim/experiment/experiment.h"
#include "sim/tradeoff/error/error_sum.h"
#include "sim/tradeoff/knob.h"

namespace greatx::sim {

/// The ticks that are run. A scenario whose sensors remember (event cameras) begins at tick 0 alone.
struct MeasurePlan {
  std::vector<int64_t> starts{0};  ///< ticks; each begins a block
  int64_t warm_up = 1;             ///< ticks of each block that are neither timed nor compared
  int64_t ticks = 4;               ///< of each block after these
  bool each_tick = false;          ///< keeps the errors of each tick by itself, too
  /// Ends early when all settings together have taken so long, but not before two timed ticks of each.
  double most_ms = std::numeric_limits<double>::infinity();
};

/// Returns the ticks from one record to the next of the sensor or channel with the highest rate; at least 1.
int64_t ticks_between_records(const Scenario& scenario);

/// Returns a plan of `blocks` blocks spread over the scenario, shortened if it has fewer ticks.
MeasurePlan plan_blocks(const Scenario& scenario, int64_t blocks, int64_t ticks);

struct SensorError {
  std::string sensor;  ///< SensorSpec::name
  ErrorFigure figure;
};

struct SettingResult {
  std::vector<double> wall_ms, cpu_ms;  ///< of each timed tick; cpu: of all threads of the process
  std::vector<double> start_ms;         ///< of starting each block: searches of paths
  double build_ms = 0.0;                ///< upload of the scene, pipelines
  bool exact = true;                    ///< all arrays of the compared records have the reference's bytes
  std::vector<SensorError> errors;      ///< against the reference
  /// [timed tick], if MeasurePlan::each_tick.
  std::vector<std::vector<SensorError>> tick_errors;
  std::vector<SensorSpec> specs;
  Packet last;  ///< the records of the last tick
};

/// `settings` is not empty; `reference` is one of them. Their sensors have the same names. Records of
/// sensors of `kind` are compared. `progress` is called with the share that is done, and may throw to stop.
/// Throws what the simulator throws.
std::vector<SettingResult> measure_settings(gpu::Device& device, const std::vector<Experiment>& settings,
                                            size_t reference, std::string_view kind, const MeasurePlan& plan,
                                            const std::function<void(double)>& progress);

/// The records of a reference that is run once, because it takes long, and compared with many settings.
struct RecordedReference {
  MeasurePlan plan;
  std::vector<SensorSpec> specs;
  std::vector<Packet> packets;  ///< of each timed tick
  std::vector<double> wall_ms;  ///< of each timed tick
};
RecordedReference record_reference(gpu::Device& device, const Experiment& reference, const MeasurePlan& plan,
                                   const std::function<void(double)>& progress);
/// Compares `settings` with the reference at its ticks.
std::vector<SettingResult> measure_settings(gpu::Device& device, const std::vector<Experiment>& settings,
                                            const RecordedReference& reference, std::string_view kind,
                                            const std::function<void(double)>& progress);

/// The settings of one knob as they were measured.
struct KnobResult {
  std::vector<SettingResult> results;  ///< [setting], without those that were refused
  size_t reference = 0;                ///< index of the setting that the others were compared with
  std::string refused;                 ///< why the finest settings are missing; empty: none is
};

/// Makes the experiment of a scenario with changes. It takes the world of `whole` if that is the same.
Experiment experiment_with(const Experiment& experiment, const std::vector<YamlChange>& changes,
                           const Experiment& whole, const std::filesystem::path& assets);

/// Measures the settings of a knob. If the finest ones are refused (for example an echo buffer beyond the
/// device's limits), it goes on without them. Throws UserError if fewer than two are left.
using MeasureFunction =
    std::function<std::vector<SettingResult>(const std::vector<Experiment>& settings, size_t reference)>;
KnobResult measure_knob(const Experiment& experiment, const Knob& knob, const Experiment& whole,
                        const std::filesystem::path& assets, const MeasureFunction& measure);

/// Of the times of ticks: median and quartiles.
struct Spread {
  double median = 0.0, low = 0.0, high = 0.0;
  size_t count = 0;
};
Spread spread_of(std::vector<double> samples);

}  // namespace greatx::sim
