// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// `greatx bench --radar`: what a frame of a scenario's first radar costs, and what fewer or more ray tubes
// make of it.
#pragma once

#include <string>

#include <nlohmann/json.hpp>

#include "apps/console/session.h"

namespace greatx::apps {

struct RadarBenchOptions {
  int64_t warm_up = 1;
  uint32_t frames = 12;  ///< measured of each row
};

/// One JSON object: scenario, device, driver, radar, triangles, transmitters, receivers, chirps, samples, and
/// - frames: rows of whole frames, name, frame_ms (from recording to arrays on the host, nothing encoded), of
///   it echoes_ms
///   (from recording to the list of echoes) and signal_ms (from there to the arrays), cpu_ms (of all
/// threads), `ratio` of
///   the medians of frame_ms to that of the first row, the scenario's own, echoes, detections (of a frame, on
/// average);
/// - echoes: rows of the same radar with `factor` times the tubes: tubes (of a frame), echoes, echoes_ms,
///   cpu_ms, and the
///   difference of their range-Doppler map, free of noise, from that of `reference_factor` times the tubes:
/// median_db and
///   q90_db of |10 log10| over the `cells` in which the reference stands above the receiver's noise (figure 0
/// dB if the
///   scenario has none); of every third frame. Target tubes get smaller and more along with the others.
/// Rows are measured in turns, frame by frame. Throws UserError if there is no radar.
nlohmann::json radar_bench(const ScenarioOptions& scenario, const RunOptions& run,
                           const RadarBenchOptions& options);
std::string radar_bench_text(const nlohmann::json& result);

}  // namespace greatx::apps
