// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string_view>
#include <vector>

#include "sim/scenario/parse/log_times.h"
#include "sim/scenario/scenario.h"

namespace greatx::sim {

/// Reads way-points from CSV, in one of two forms.
///
/// In metres: t, x, y, z in s and m, and optionally yaw, pitch, roll in degrees. One header line may name the
/// columns (t or t_s or time_s, x or x_m, ..., yaw_deg, pitch_deg, roll_deg: in this order).
///
/// On the Earth: a header line names the columns time, lat, lon, height, and optionally yaw_deg, pitch_deg,
/// roll_deg, in any order (place_table.h has the spellings).
///
/// Behind a header line times may be dates with their offsets. Empty lines and lines that begin with '#' are
/// skipped. Times ascend strictly, and every number is finite. Throws UserError "file:line:column: expected
/// ..., found ...".
std::vector<WayPoint> load_way_points(const std::filesystem::path& file, const WayPointLog& log = {});
/// Does the same from text; `name` stands for the file in messages.
std::vector<WayPoint> parse_way_points(std::string_view text, const std::string& name,
                                       const WayPointLog& log = {});

}  // namespace greatx::sim
