// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// `greatx bench --rig`: what a tick of the whole scenario costs, written to disk, and what each sensor of it
// does.
#pragma once

#include <string>

#include <nlohmann/json.hpp>

#include "apps/console/session.h"

namespace greatx::apps {

struct RigBenchOptions {
  int64_t warm_up = 5;
  uint32_t rounds = 4;  ///< measured of each row
  int64_t block = 8;    ///< ticks of a round
};

/// One JSON object: scenario, device, driver, cores (of the host), block, rounds, and rows: name, wall_ms and
/// cpu_ms (of all threads of this program) of a tick, from its recording until its files are on disk. The
/// first row is the whole scenario; then nothing written, and the scenario without each of its sensors and
/// channels, with `cost_wall_ms` and `cost_cpu_ms`: the medians over rounds of what the whole scenario took
/// more in the same round. Rows take turns, a block of ticks at a time, the order reversed every second
/// round; between blocks nothing is in flight, so that a block's time holds one tick that nothing overlaps.
/// Costs need not add up: what two sensors share is in neither's. Fewer ticks than all rounds need make fewer
/// rounds. Throws UserError if the scenario has no sensor, or fewer ticks than warm-up and one block.
nlohmann::json rig_bench(const ScenarioOptions& scenario, const RunOptions& run,
                         const RigBenchOptions& options);
std::string rig_bench_text(const nlohmann::json& result);

}  // namespace greatx::apps
