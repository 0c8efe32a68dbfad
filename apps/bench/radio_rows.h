// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// The rows of `greatx bench --radio`: each measures one thing and returns {"ms" or distributions, "target",
// "ratio", ...}. Every row runs in a process of its own.
#pragma once

#include <nlohmann/json.hpp>

#include "apps/bench/measure.h"
#include "apps/bench/radio_bench.h"
#include "sim/scenario/scenario.h"

namespace greatx::apps {

/// A row's effects beside line of sight and reflection.
struct TickRow {
  const char* name;
  bool diffraction, scattering;
};
constexpr TickRow tick_rows[] = {{"reflection_transmission", false, false},
                                 {"diffraction", true, false},
                                 {"scattering", false, true},
                                 {"diffraction_scattering", true, true}};

nlohmann::json first_cir_row(const ScenarioOptions& options, const RunOptions& run, Clock::time_point begin);
nlohmann::json search_row(const ScenarioOptions& options);
nlohmann::json tick_row(const ScenarioOptions& scenario, const RunOptions& run,
                        const RadioBenchOptions& options, const TickRow& which);
/// Paths of `receivers` drawn points in one call.
nlohmann::json many_row(const ScenarioOptions& scenario, const RunOptions& run, uint32_t receivers);
/// Their frequency responses as well, written to a file.
nlohmann::json many_responses_row(const ScenarioOptions& scenario, const RunOptions& run, uint32_t receivers);
/// A radio map of so many cells of 1 m along each side.
nlohmann::json map_row(const ScenarioOptions& scenario, const RunOptions& run, uint32_t side_cells);
/// H of the channel's ports and subcarriers from 20 paths, on one thread.
nlohmann::json response_row(const ScenarioOptions& scenario, const RunOptions& run);
/// The whole tick of the channel, written to disk.
nlohmann::json written_tick_row(const ScenarioOptions& scenario, const RunOptions& run,
                                const RadioBenchOptions& options);

// What the rows share.

/// The scenario's first channel and nothing else.
sim::Scenario radio_only(const ScenarioOptions& options, const TickRow& row);
void set_target(nlohmann::json& row, double target, double measured);

/// Whether a row of ticks has enough.
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
