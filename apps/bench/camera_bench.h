// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// `greatx bench --camera`: measures the time of a picture of a scenario's first camera, and how each setting
// changes it.
#pragma once

#include <string>

#include <nlohmann/json.hpp>

#include "apps/console/session.h"

namespace greatx::apps {

struct CameraBenchOptions {
  int64_t warm_up = 3;     ///< pictures of each row that are taken first and not measured
  uint32_t pictures = 24;  ///< measured pictures of each row
};

/// Returns one JSON object with scenario, device, driver, camera, width, height, triangles and `rows`. A row
/// has:
/// - name;
/// - tick_ms: time from the recording of the commands to the arrays on the host, without encoding;
/// - cpu_ms: processor time of all threads;
/// - ratio: median of tick_ms divided by that of the first row;
/// - lamps_placed, and lamps_seen on average;
/// - rmse_8bit: rms difference of the 8-bit rgb. Rows of antialiasing are compared with a picture of 16
///   samples a pixel, which gives their error. Rows without an effect are compared with the first row, which
///   shows how much the effect changes;
/// - target_ms: the time to reach, where there is one.
/// The last rows are those of an event camera (apps/bench/event_row.h). The rows take turns, picture by
/// picture, along the camera's trajectory, so that the state of the machine affects all of them alike. Throws
/// UserError if the scenario has no camera.
nlohmann::json camera_bench(const ScenarioOptions& scenario, const RunOptions& run,
                            const CameraBenchOptions& options);
/// Returns the result as a table.
std::string camera_bench_text(const nlohmann::json& result);

}  // namespace greatx::apps
