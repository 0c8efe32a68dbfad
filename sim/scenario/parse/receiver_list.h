// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "core/vec.h"
#include "sim/scenario/parse/earth_positions.h"

namespace greatx::sim {

/// Reads positions of receivers from CSV, one a line, in one of two forms. In metres: x, y, z in world
/// coordinates; one header line may name the columns (x or x_m, y or y_m, z or z_m: in this order). On the
/// Earth: a header line names the columns lat, lon, height, in any order (place_table.h has the spellings).
/// Empty lines and lines that begin with '#' are skipped. Every number is finite. A position may occur twice.
/// Throws UserError "file:line:column: field: expected ..., found ...".
std::vector<dvec3> load_receiver_list(const std::filesystem::path& file, const EarthPositions& earth = {});
/// Does the same from text; `name` stands for the file in messages.
std::vector<dvec3> parse_receiver_list(std::string_view text, const std::string& name,
                                       const EarthPositions& earth = {});

}  // namespace greatx::sim
