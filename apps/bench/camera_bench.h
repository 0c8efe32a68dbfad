// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// `greatx bench --camera`: what a picture of a scenario's first camera costs, and what each knob of it
// changes.
#pragma once

#include <string>

#include <nlohmann/json.hpp>

#include "apps/console/session.h"

namespace greatx::apps {

struct CameraBenchOptions {
  int64_t warm_up = 3;
  uint32_t pictures = 24;  ///< measured of each row
};

/// One JSON object: scenario, device, driver, camera, and rows: name, tick_ms (from recording to arrays on
/// the host, nothing encoded), cpu_ms (of all threads), `ratio` of the medians to that of the first row,
/// lamps (placed, seen on average), rmse_8bit (of rgb against 16 samples a pixel: the error of the
/// antialiasing; against the first row: what an effect changes) and `target_ms` where there is one; last the
/// rows of an event camera (apps/bench/event_row.h). Rows are measured in turns, picture by picture, along
/// the camera's way, so that all see the same machine.
nlohmann::json camera_bench(const ScenarioOptions& scenario, const RunOptions& run,
                            const CameraBenchOptions& options);
std::string camera_bench_text(const nlohmann::json& result);

}  // namespace greatx::apps
