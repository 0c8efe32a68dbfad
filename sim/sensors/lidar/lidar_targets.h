// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Computes the poses of bodies during the sweep of a LiDAR.
#pragma once

#include <span>
#include <vector>

#include "renderer/lidar/lidar_pass.h"
#include "sim/sensors/sensor.h"
#include "sim/world/world.h"

namespace greatx::sim {

/// Describes a sweep.
struct SweepView {
  uint32_t unseen_body = 0;           ///< a body that the beams pass through, with its parts; 0: none
  std::span<const double> times_s;    ///< times of the shots after the tick, ascending
  std::span<const Pose> local_poses;  ///< poses of the sensor at these times, or one for all
  double max_range_m = 0.0;
};

/// Returns every body that a beam may meet, with its motion over the sweep. If no body moves during the
/// sweep, the bodies are not traced separately: all have their poses at the tick. A body is left out if it is
/// more than 10 m beyond the range at every sixteenth of the times. A body has no motion if it has its pose
/// at the tick at all of these times. A part that turns always has a motion, since it may complete whole
/// turns between two of these times.
render::LidarTargets lidar_targets(const World& world, const TickContext& context, const SweepView& view);

}  // namespace greatx::sim
