// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Measures settings of one knob in turns: each tick is run under every setting before the next one, so that
// a machine that becomes slower does so for all of them. A tick is run alone, without its neighbours beside
// it: it is submitted, and the host waits for it and collects it.
#pragma once

#include <functional>
#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "core/record.h"
#include "gpu/device.h"
#include "sim/experiment/experiment.h"
#include "sim/tradeoff/error/error_sum.h"

namespace greatx::sim {

/// The ticks that are run. A scenario whose sensors remember (event cameras) begins at tick 0 alone.
struct MeasurePlan {
  std::vector<int64_t> starts{0};  ///< ticks; each begins a block
  int64_t warm_up = 1;             ///< ticks of each block that are neither timed nor compared
  int64_t ticks = 4;               ///< of each block after these
};

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
  std::vector<SensorSpec> specs;
  Packet last;  ///< the records of the last tick
};

/// `settings` is not empty; `reference` is one of them. Their sensors have the same names. Records of
/// sensors of `kind` are compared. `progress` is called with the share that is done, and may throw to stop.
/// Throws what the simulator throws.
std::vector<SettingResult> measure_settings(gpu::Device& device, const std::vector<Experiment>& settings,
                                            size_t reference, std::string_view kind, const MeasurePlan& plan,
                                            const std::function<void(double)>& progress);

/// Of the times of ticks: median and quartiles.
struct Spread {
  double median = 0.0, low = 0.0, high = 0.0;
  size_t count = 0;
};
Spread spread_of(std::vector<double> samples);

}  // namespace greatx::sim
