// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// The rows of `greatx bench --radio`. Each function measures one thing and returns {"ms" or distributions,
// "target", "ratio", ...}. Every row runs in a process of its own.
#pragma once

#include <nlohmann/json.hpp>

#include "apps/bench/measure.h"
#include "apps/bench/radio_bench.h"
#include "sim/channel/channel_snapshot.h"
#include "sim/scenario/scenario.h"

namespace greatx::apps {

/// Selects the effects of a row besides line of sight, reflection and transmission.
struct TickRow {
  const char* name;
  bool diffraction, scattering;
};
constexpr TickRow tick_rows[] = {{"reflection_transmission", false, false},
                                 {"diffraction", true, false},
                                 {"scattering", false, true},
                                 {"diffraction_scattering", true, true}};

/// Measures the time from `begin` to the record of the first tick.
nlohmann::json first_cir_row(const ScenarioOptions& options, const RunOptions& run, Clock::time_point begin);
/// Measures the beam search without the cache.
nlohmann::json search_row(const ScenarioOptions& options);
/// Measures the ticks of the channel, pipelined and stage by stage, with the effects of `which`.
nlohmann::json tick_row(const ScenarioOptions& scenario, const RunOptions& run,
                        const RadioBenchOptions& options, const TickRow& which);
/// Measures the paths to `receivers` drawn points, solved in one call.
nlohmann::json many_row(const ScenarioOptions& scenario, const RunOptions& run, uint32_t receivers);
/// Measures the same with the frequency responses, written to a file.
nlohmann::json many_responses_row(const ScenarioOptions& scenario, const RunOptions& run, uint32_t receivers);
/// Measures a radio map with `side_cells` cells of 1 m along each side.
nlohmann::json map_row(const ScenarioOptions& scenario, const RunOptions& run, uint32_t side_cells);
/// Measures the frequency response H of the channel's ports and subcarriers from 20 paths, on one thread.
nlohmann::json response_row(const ScenarioOptions& scenario, const RunOptions& run);
/// Measures the gradient of a real loss of this H by 12 parameters of materials, on one thread: `ms`, beside
/// `forward_ms`, the fields of the paths and H, and `error`, the largest difference from differences.
nlohmann::json gradient_row(const ScenarioOptions& scenario, const RunOptions& run);
/// Measures the whole tick of the channel, written to disk.
nlohmann::json written_tick_row(const ScenarioOptions& scenario, const RunOptions& run,
                                const RadioBenchOptions& options);

// Functions that several rows use.

/// Returns the scenario with its first channel only and no sensors but antennas, with diffraction and
/// scattering switched as in `row`. Throws UserError if there is no channel.
sim::Scenario radio_only(const ScenarioOptions& options, const TickRow& row);
/// Returns exactly `count` paths of links of the channel, repeated or cut as needed: the time of their sum
/// does not depend on which paths they are. Throws UserError if no point has a path.
std::vector<rf::Path> some_paths(sim::ChannelSnapshot& snapshot, std::span<const dvec3> points, size_t count);
/// Sets `target`, and `ratio` to `measured` / `target`.
void set_target(nlohmann::json& row, double target, double measured);

/// Decides when a row of ticks has enough samples: at least 3, and RadioBenchOptions::seconds are over.
class Until {
 public:
  explicit Until(const RadioBenchOptions& options) : options_(options), begin_(Clock::now()) {}
  bool enough(size_t samples) const {
    return samples >= 3 && milliseconds_since(begin_) > 1e3 * options_.seconds;
  }

 private:
  const RadioBenchOptions& options_;
  Clock::time_point begin_;
};

}  // namespace greatx::apps
