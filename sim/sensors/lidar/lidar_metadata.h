// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// What a LiDAR says of its data.
#pragma once

#include <vector>

#include "core/record.h"
#include "renderer/lidar/lidar_pass.h"
#include "sim/scenario/scenario.h"
#include "sim/sensors/sensor_metadata.h"

namespace greatx::sim {

/// The arrays that some output holds, in the order of arrays_of: `points` alone for bare points (npy, KITTI),
/// all of them for clouds with their properties (PLY, PCD).
std::vector<ArraySpec> lidar_arrays(const LidarConfig::Outputs& outputs);
std::vector<Array> arrays_of(const render::LidarScan& scan, const LidarConfig::Outputs& outputs);
/// Scan pattern, beam, returns and receiver as they are used, effects that are off left out.
nlohmann::json lidar_metadata(const LidarConfig& config, const render::LidarDesc& desc);

}  // namespace greatx::sim
