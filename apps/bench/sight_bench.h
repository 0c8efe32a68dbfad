// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// `greatx bench --line-of-sight`: measures the first channel of a scenario with every effect of radio off but
// the line of sight, beside a program that was built without the others (preset `lean`).
#pragma once

#include <string>

#include <nlohmann/json.hpp>

#include "apps/console/session.h"

namespace greatx::apps {

struct SightBenchOptions {
  uint32_t receivers = 1000;  ///< receivers that are solved in one call
  int64_t warm_up = 5;        ///< first ticks, not measured
  double seconds = 10.0;      ///< ticks are measured for so long
  uint32_t repeats = 20;      ///< calls for all receivers
  std::string against;        ///< the other program; empty: none
  uint32_t pairs = 5;         ///< runs of each program, in turns
};

/// Without another program: returns scenario, device, driver, the effects built, and the distributions
/// tick_ms (a whole tick of a run, nothing written) and links_ms (paths and frequency responses of all
/// receivers in one call, on the host and the device).
///
/// With another program: runs this one and the other in turns, each in a process of its own, in an order that
/// is reversed every second time. Returns `this` and `against`, each with the median over the runs of the
/// median of each figure, and `ratio`, the distribution over the pairs of this program's median divided by
/// the other's. Throws UserError if the scenario has no channel or the other program fails.
nlohmann::json sight_bench(const ScenarioOptions& scenario, const RunOptions& run,
                           const SightBenchOptions& options);
/// Returns the result as a table.
std::string sight_bench_text(const nlohmann::json& result);

}  // namespace greatx::apps
