// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Reads a LiDAR's shots from CSV (docs/scenario.md, "A table of shots").
#pragma once

#include <filesystem>
#include <string>
#include <string_view>

#include "renderer/lidar/scan/scan_pattern.h"

namespace greatx::sim {

/// Reads the columns t_s, azimuth_deg, elevation_deg and optionally channel (0 to 65534), in this order. One
/// header line may name them. Times count from the tick, are 0 or more, and never descend. Azimuths are -360
/// to 360 (left is positive), elevations -90 to 90. Throws UserError "file:line:column: expected ..., found
/// ...".
render::ShotTable load_shots(const std::filesystem::path& file);
/// Does the same from text; `name` stands for the file in messages.
render::ShotTable parse_shots(std::string_view text, const std::string& name);

}  // namespace greatx::sim
