// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Describes the data of a LiDAR.
#pragma once

#include <vector>

#include "core/record.h"
#include "renderer/lidar/lidar_pass.h"
#include "sim/scenario/scenario.h"
#include "sim/sensors/sensor_metadata.h"

namespace greatx::sim {

/// Returns the declarations of the arrays that the outputs hold, in the order of arrays_of: `points` alone
/// for bare points (npy, KITTI), all arrays for clouds with properties (PLY, PCD).
std::vector<ArraySpec> lidar_arrays(const LidarConfig& config);
/// Returns the largest distance between a point and its coordinates, m, if they are multiples of a step: half
/// a step along each axis, and the last bit of a float.
double point_error_m(const LidarConfig& config);
/// Rounds the coordinates of points to the multiples of a step, m, that are nearest.
void round_points(render::LidarScan& scan, double step_m);
/// Returns the arrays of a scan.
std::vector<Array> arrays_of(const render::LidarScan& scan, const LidarConfig::Outputs& outputs);
/// Returns scan pattern, beam, returns and receiver as used by the run; effects that are off are left out.
nlohmann::json lidar_metadata(const LidarConfig& config, const render::LidarDesc& desc);

}  // namespace greatx::sim
