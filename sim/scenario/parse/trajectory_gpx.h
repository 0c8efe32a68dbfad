// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string_view>
#include <vector>

#include "sim/scenario/parse/log_times.h"
#include "sim/scenario/scenario.h"

namespace greatx::sim {

/// Reads the track of a GPX file (GPX 1.1 Schema, topografix.com, 2004; 1.0 has the same track points) as
/// way-points. There is one track; its segments follow each other, and the way between two of them is that
/// between their ends. Each point has latitude, longitude, <ele> and <time>. Other elements are not read.
/// Throws UserError "file:line: expected ..., found ...".
std::vector<WayPoint> load_gpx(const std::filesystem::path& file, const WayPointLog& log);
/// Does the same from text; `name` stands for the file in messages.
std::vector<WayPoint> parse_gpx(std::string_view text, const std::string& name, const WayPointLog& log);

}  // namespace greatx::sim
