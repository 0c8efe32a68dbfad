// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "sim/scenario/accuracy.h"

#include <limits>

namespace greatx::sim {

namespace {

constexpr double none = std::numeric_limits<double>::quiet_NaN();

constexpr AccuracyKind kinds[] = {
    {"csi_nmse_db", "csi", "nmse", "dB", -200.0, 0.0, -30.0, false, "error of H(f) relative to its power"},
    {"csi_path_gain_db", "csi", "path_gain_p95", "dB", 1e-9, 100.0, none, false,
     "95th percentile of the error of the links' path gain"},
    {"csi_delay_spread_ns", "csi", "delay_spread", "ns", 1e-9, 1e6, none, false,
     "median error of the delay spread"},
    {"rgb_flip", "camera", "flip", "1", 1e-9, 1.0, 0.05, false, "mean of FLIP over a picture"},
    {"rgb_ssim", "camera", "ssim", "1", 1e-9, 1.0, none, false, "1 - mean structural similarity"},
    {"depth_m", "camera", "depth", "m", 1e-9, 1e6, none, false, "mean error of the depth"},
    {"flow_px", "camera", "flow", "px", 1e-9, 1e6, none, false, "mean error of the motion of pixels"},
    {"event_voxels", "events", "voxels", "1", 1e-9, 10.0, 0.2, false, "relative L1 error of a voxel grid"},
    {"event_count_percent", "events", "count", "%", 1e-9, 1e6, none, false, "error of the number of events"},
    {"event_time_us", "events", "time", "us", 1e-9, 1e9, none, false, "median error of the time of an event"},
    {"lidar_range_m", "lidar", "range", "m", 1e-9, 1e6, 0.01, false, "mean error of the range"},
    {"lidar_missed_percent", "lidar", "missed", "%", 1e-9, 100.0, 1.0, true,
     "returns that only one side has"},
    {"lidar_intensity", "lidar", "intensity", "1", 1e-9, 1e6, 0.05, true, "mean error of the intensity"},
    {"radar_map_db", "radar", "map", "dB", -200.0, 0.0, -10.0, false,
     "error of the range-Doppler map relative to its power"},
    {"rcs_db", "radar", "power", "dB", 1e-9, 100.0, none, false, "median error of the power of a detection"},
    {"radar_missed_percent", "radar", "missed", "%", 1e-9, 100.0, 10.0, true, "detections that are missed"}};

}  // namespace

std::span<const AccuracyKind> accuracy_kinds() { return kinds; }

}  // namespace greatx::sim
