// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// `greatx bench --lidar`: measures the time of a sweep of a scenario's first LiDAR, and the time that each
// effect adds.
#pragma once

#include <string>

#include <nlohmann/json.hpp>

#include "apps/console/session.h"

namespace greatx::apps {

struct LidarBenchOptions {
  int64_t warm_up = 3;                           ///< first sweeps of each row, not measured
  uint32_t sweeps = 24;                          ///< measured sweeps of each row
  uint32_t channels = 64, azimuth_steps = 1024;  ///< size of the sweep in all rows but the last
};

/// Returns one JSON object with scenario, device, driver, lidar, triangles, `rows` and `left_out`. A row has:
/// - name;
/// - tick_ms: time from the recording of the commands to the arrays on the host, without encoding;
/// - cpu_ms: processor time of all threads;
/// - ratio: median of tick_ms divided by that of the first row;
/// - shots of a sweep, rays of a shot, and returns of a sweep on average;
/// - effects that are on.
/// The first row is a sweep of channels x azimuth_steps single rays, all at the time of the tick, without any
/// effect. Each of the next rows adds one thing to that sweep. The last row is the scenario's own LiDAR.
/// `left_out` holds the names of the rows whose effect the scene does not need, with the reasons. The rows
/// take turns, sweep by sweep, along the LiDAR's trajectory. Throws UserError if there is no LiDAR.
nlohmann::json lidar_bench(const ScenarioOptions& scenario, const RunOptions& run,
                           const LidarBenchOptions& options);
/// Returns the result as a table.
std::string lidar_bench_text(const nlohmann::json& result);

}  // namespace greatx::apps
