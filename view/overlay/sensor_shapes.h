// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// The sensors themselves: frusta, axes, antennas.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>

#include "view/overlay/record_tables.h"
#include "view/overlay/shapes.h"

namespace greatx::view {

struct SensorOptions {
  double frustum_m = 4.0;  ///< planar depth as far as which a frustum is drawn
  double axis_m = 0.6;
  double pattern_m = 1.5;  ///< from the origin of a pattern to its strongest direction
  bool names = true, cameras = true, axes = true, antennas = true, patterns = true;
  /// Nothing is drawn of what this node carries: one looks through its camera, and would see it from inside.
  std::optional<uint32_t> hidden_node;
  size_t most_elements = 4'096;  ///< dots of one panel; of more, every n-th, which its row says
  size_t most_patterns = 16;     ///< the legend says how many antennas have none
};

/// Cameras and event cameras as frusta (their distortion is left out, and their rows say so), LiDARs and
/// radars as axes (x red, y green, z blue), and the antennas of the channels: panel elements as dots, and
/// the power pattern of an element as a surface of lines whose distance from the antenna falls from pattern_m
/// to 0 over 30 dB. Everything is at the tick of the poses. Null poses: empty, and the legend says so.
Shapes sensor_shapes(const RecordTables& tables, const NodePoses* poses, const SensorOptions& options);

/// The direction of a pixel coordinate in the sensor's frame (x forward, y left, z up), of planar depth 1,
/// without distortion. (0, 0) is the picture's upper left corner.
dvec3 pixel_ray(const CameraFacts& camera, double u, double v);

}  // namespace greatx::view
