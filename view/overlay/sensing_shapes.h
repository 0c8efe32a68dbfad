// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// What LiDARs and radars measured, in the world, from their records. Each function throws UserError if an
// array is not as docs/dataset.md has it. Where an array that it needs was not recorded, or the poses are
// null, the shapes are empty and the legend says why.
#pragma once

#include <cstddef>

#include "core/record.h"
#include "view/overlay/record_tables.h"
#include "view/overlay/shapes.h"

namespace greatx::view {

enum class LidarColors { height, intensity, ring, instance };

struct LidarOptions {
  LidarColors colors = LidarColors::height;
  size_t most = 100'000;  ///< points; of more, every n-th is shown, which the legend says
  float size_px = 1.5f;
};

/// The returns of a sweep. Points are in the sensor's frame at the time of their own shot; where the run has
/// the effect lidar_sweep_motion, each is placed by the pose at its time_offset, from the velocities at the
/// tick. With the array "instance" each point has the row of its object.
Shapes lidar_shapes(const RecordTables& tables, const SensorSpec& spec, const Record& record,
                    const NodePoses* poses, const LidarOptions& options);

struct RadarOptions {
  /// An arrow is as long as what its target moves in this time, along the line of sight, m per m/s.
  double arrow_s = 1.0;
  bool fan = true;         ///< the field of view at elevation 0, as far as ranges are unambiguous
  double fan_range_m = 0;  ///< of the fan; 0: the unambiguous range
  /// The resolution cell of each detection: one range bin by one beam (docs/viewer.md). Of a bistatic radar
  /// there is none, because its cells are no frusta.
  bool cells = false;
};

/// The detections as diamonds (false alarms: crosses) with arrows: away from the radar where the target
/// recedes. Positions hold in the middle of the frame, so they are placed by the pose at that time. An arrow
/// of a bistatic radar points along the gradient of the range, half of the way from transmitter to receiver.
Shapes radar_shapes(const RecordTables& tables, const SensorSpec& spec, const Record& record,
                    const NodePoses* poses, const RadarOptions& options);

}  // namespace greatx::view
