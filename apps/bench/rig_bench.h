// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// `greatx bench --rig`: measures the time of a tick of the whole scenario, written to disk, and the part of
// each sensor and channel in it.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "apps/console/session.h"

namespace greatx::apps {

struct RigBenchOptions {
  int64_t warm_up = 5;  ///< first ticks of each row, not measured
  uint32_t rounds = 4;  ///< measured rounds of each row
  int64_t block = 8;    ///< ticks of a round
  /// Numbers of moving cars that are added to the scenario, a row each. Empty: rows without each sensor.
  std::vector<uint32_t> bodies;
};

/// Returns one JSON object with scenario, device, driver, cores of the host, block, rounds and `rows`. A row
/// has a name, and wall_ms and cpu_ms (of all threads of this program) of a tick, from the recording of its
/// commands until its files are on disk. The first row is the whole scenario. The second one writes nothing.
/// Each further row leaves out one sensor or channel. All rows but the first have `cost_wall_ms` and
/// `cost_cpu_ms`: the median over the rounds of how much more time the whole scenario took in the same round.
/// With `bodies` the rows are the scenario with so many cars that drive and turn around the origin of the
/// world, and the costs are how much more time a row took than the first one.
///
/// The rows take turns, a block of ticks at a time, in an order that is reversed every second round. Between
/// blocks no tick is in flight, so the time of a block includes one tick that overlaps with no other. The
/// costs need not add up: work that two sensors share is part of neither's cost. If the scenario has too few
/// ticks, the number of rounds is reduced. Throws UserError if the scenario has no sensor and no channel, or
/// fewer ticks than the warm-up and one block.
nlohmann::json rig_bench(const ScenarioOptions& scenario, const RunOptions& run,
                         const RigBenchOptions& options);
/// Returns the result as a table.
std::string rig_bench_text(const nlohmann::json& result);

}  // namespace greatx::apps
