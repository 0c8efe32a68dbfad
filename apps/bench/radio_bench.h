// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// `greatx bench --radio`: measures the time and memory of the first channel of a scenario, without the other
// sensors and channels. Each row runs in a process of its own (apps/bench/row_process.h), so that its memory
// is counted separately.
#pragma once

#include <string>

#include <nlohmann/json.hpp>

#include "apps/console/session.h"

namespace greatx::apps {

struct RadioBenchOptions {
  uint32_t receivers = 1000;  ///< number of receivers of the rows that solve many in one call
  uint32_t map_cells = 0;     ///< cells of 1 m along each side of a radio map; 0: no such row
  int64_t warm_up = 5;        ///< first ticks of a row, not measured
  /// A row of ticks ends after this time, but not before 3 ticks; or after the scenario's last tick.
  double seconds = 10.0;
};

/// Returns one JSON object with scenario, device, driver, facets and these rows:
/// - first_cir: ms from the start of the process to the record of the first tick, and whether the search came
///   from the cache. If it did not, the row is measured again with the cache;
/// - search: ms, candidates and guarantee of the beam search, without the cache;
/// - ticks: four rows, for line of sight + reflection + transmission, and for the same with diffraction, with
///   scattering and with both. tick_ms is the time of the whole pipelined tick, with nothing written. The
///   stages are also measured one after the other: geometry_ms, crossings_ms (GPU, until the submission is
///   done), fields_ms, response_ms (frequency responses of all receivers);
/// - many: `receivers` points in one call, ms and paths;
/// - many_responses: the same with their frequency responses, written to a file;
/// - response: one frequency response from 20 paths, on one thread;
/// - written_tick: tick_ms of the whole tick, written to disk;
/// - map: if requested, a radio map: ms, cells, number of solved cells, paths.
/// Each row has cpu_s and peak_rss_bytes. `target` is the time to reach, in ms, and `ratio` is the measured
/// time divided by it.
nlohmann::json radio_bench(const ScenarioOptions& scenario, const RunOptions& run,
                           const RadioBenchOptions& options);
/// Returns the result as a table.
std::string radio_bench_text(const nlohmann::json& result);

}  // namespace greatx::apps
