// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// `greatx bench --lidar`: what a sweep of a scenario's first LiDAR costs, and what each effect adds.
#pragma once

#include <string>

#include <nlohmann/json.hpp>

#include "apps/console/session.h"

namespace greatx::apps {

struct LidarBenchOptions {
  int64_t warm_up = 3;
  uint32_t sweeps = 24;                          ///< measured of each row
  uint32_t channels = 64, azimuth_steps = 1024;  ///< of all rows but the last
};

/// One JSON object: scenario, device, driver, lidar, triangles, and rows: name, tick_ms (from recording to
/// arrays on the host, nothing encoded), cpu_ms (of all threads), `ratio` of the medians to that of the first
/// row, shots, rays (of a shot), returns (of a sweep, on average), effects (that are on). The first row is a
/// sweep of channels x azimuth_steps single rays at the tick without any effect; the next ones are that and
/// one thing more, the last one is the scenario's own. `left_out`: name and reason of rows whose effect the
/// scene does not call for. Rows are measured in turns, sweep by sweep, along the LiDAR's way. Throws
/// UserError if there is no LiDAR.
nlohmann::json lidar_bench(const ScenarioOptions& scenario, const RunOptions& run,
                           const LidarBenchOptions& options);
std::string lidar_bench_text(const nlohmann::json& result);

}  // namespace greatx::apps
