// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// The report of `greatx tradeoff`. It is made from one JSON object:
//
//   {"scenario", "device", "driver", "cores", "greatx", "quick", "how", "minutes",
//    "knobs": [{"name", "modality", "timed", "about", "context", "unit", "reference", "default", "skipped",
//               "legend",
//               "settings": [{"label", "value", "tick_ms", "cpu_ms", "start_ms", "exact", "picture",
//                             "errors": [{"sensor", "name", "unit", "value", "meaning"}]}]}],
//    "absent": [{"name", "why"}],
//    "fronts": [{"modality", "sensor", "figure", "unit", "how", "context", "costly",
//                "points": [{"settings": {KNOB: LABEL}, "predicted_ms", "predicted_error",
//                            "tick_ms", "error", "default", "reference"}]}]}
//
// "timed" says what tick_ms and cpu_ms are of: "tick" (also if it is absent), or "map". They are
// {"median", "low", "high", "count"}, with the quartiles. `value` of an error is null
// for minus infinity dB. `default` is empty if the scenario's own value is none of the settings.
#pragma once

#include <filesystem>
#include <string>

#include <nlohmann/json.hpp>

#include "core/record.h"

namespace greatx::apps {

/// Writes tradeoff.csv (a row for each figure of each setting), plots/MODALITY-KNOB.svg, overview.svg, and
/// index.html, which has everything in itself, with the pictures that the settings name. Throws UserError if
/// a picture cannot be read.
void write_report(const nlohmann::json& report, const std::filesystem::path& folder);

/// Returns in words how the settings of a knob compare: what the cheaper ones cost, where to stop, whether
/// the default is beaten.
std::string words_of_knob(const nlohmann::json& knob);

/// Returns the plot of a knob as SVG: the first figure of error over the time of a tick.
std::string plot_of_knob(const nlohmann::json& knob, const std::string& device);

/// Draws what a record shows, u8 [h, w, 3]: a camera's picture, events, the points of a LiDAR from above, the
/// range-Doppler map of a radar, the path gain of the strongest transmitter of a radio map. Empty for other
/// kinds.
Array picture_of(const SensorSpec& spec, const Record& record);
/// Says what the colours of such pictures mean; empty where pictures speak for themselves.
std::string legend_of(const SensorSpec& spec);

}  // namespace greatx::apps
