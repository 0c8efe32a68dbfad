// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// `greatx bench --radio`: what the first channel of a scenario costs apart from everything else. Each row is
// measured in a process of its own (apps/bench/row_process.h), so its memory is its own.
#pragma once

#include <string>

#include <nlohmann/json.hpp>

#include "apps/console/session.h"

namespace greatx::apps {

struct RadioBenchOptions {
  uint32_t receivers = 1000;  ///< of the row that solves many in one call
  uint32_t map_cells = 0;     ///< along each side of a radio map, of 1 m; 0: no such row
  int64_t warm_up = 5;
  double seconds =
      10.0;  ///< a row of ticks ends after the scenario's last one or as long as this, with 3 ticks at least
};

/// One JSON object: scenario, device, driver, facets, and
/// - first_cir: ms from the start of the process to the record of the first tick, and whether the search was
///   cached (if it
///   was not, it is measured again, when it is);
/// - search: ms, candidates and guarantee of the beam search, the cache left out;
/// - ticks: for line of sight + reflection + transmission, the same with diffraction, with scattering, and
///   with both:
///   tick_ms of the whole pipelined tick (nothing written), and stage by stage, one after the other:
/// geometry_ms,
///   crossings_ms (GPU: until the submission is done), fields_ms, response_ms (the frequency response of all
/// receivers);
/// - many: `receivers` points in one call, ms and paths; many_responses: with their frequency responses,
///   written to a file;
/// - response: one frequency response from 20 paths, on one thread;
/// - written_tick: tick_ms of the whole tick, written to disk;
/// - map: if it is asked for, a radio map, ms, cells, solved of them, paths.
/// Each row has cpu_s and peak_rss_bytes; `target` is the figure to reach and `ratio` the measured one over
/// it.
nlohmann::json radio_bench(const ScenarioOptions& scenario, const RunOptions& run,
                           const RadioBenchOptions& options);
std::string radio_bench_text(const nlohmann::json& result);

}  // namespace greatx::apps
