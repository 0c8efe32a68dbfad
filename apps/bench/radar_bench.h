// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// `greatx bench --radar`: measures the time of a frame of a scenario's first radar, and how the number of ray
// tubes changes the time and the error.
#pragma once

#include <string>

#include <nlohmann/json.hpp>

#include "apps/console/session.h"

namespace greatx::apps {

struct RadarBenchOptions {
  int64_t warm_up = 1;   ///< frames of each row that are computed first and not measured
  uint32_t frames = 12;  ///< measured frames of each row
};

/// Returns one JSON object with scenario, device, driver, radar, triangles, transmitters, receivers, chirps,
/// samples and two lists of rows.
/// `frames` holds rows of whole frames:
/// - name;
/// - frame_ms: time from the recording of the commands to the arrays on the host, without encoding. It is the
///   sum of echoes_ms, up to the list of echoes, and signal_ms, from there to the arrays;
/// - cpu_ms: processor time of all threads;
/// - ratio: median of frame_ms divided by that of the first row, which is the scenario's own radar;
/// - echoes and detections of a frame, on average.
/// `echoes` holds rows of the same radar with `factor` times the tubes. Target tubes become smaller and more
/// numerous along with the others.
/// - tubes of a frame, echoes, echoes_ms, cpu_ms;
/// - median_db and q90_db: difference of the range-Doppler map, without noise, from that of a reference with
///   `reference_factor` times the tubes. They are the median and the 90 % quantile of |10 log10 of the ratio|
///   over the `cells` where the reference is above the receiver's noise. Every third frame is compared. The
///   noise figure is 0 dB if the scenario has none. The last row is the reference.
/// The rows take turns, frame by frame. Throws UserError if there is no radar.
nlohmann::json radar_bench(const ScenarioOptions& scenario, const RunOptions& run,
                           const RadarBenchOptions& options);
/// Returns the result as two tables.
std::string radar_bench_text(const nlohmann::json& result);

}  // namespace greatx::apps
