// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Where bodies stand while a LiDAR sweeps.
#pragma once

#include <span>
#include <vector>

#include "renderer/lidar/lidar_pass.h"
#include "sim/sensors/sensor.h"
#include "sim/world/world.h"

namespace greatx::sim {

/// What a LiDAR asks of the bodies.
struct SweepView {
  uint32_t unseen_body = 0;           ///< that its beams pass through, with its parts; 0: none
  std::span<const double> times_s;    ///< of the shots after the tick, ascending
  std::span<const Pose> local_poses;  ///< of the sensor at those times, or one for all
  double max_range_m = 0.0;
};

/// Every body that a beam may meet, with its motion over the sweep. Not apart if none moves meanwhile: then
/// they all stand where they are at the tick. A body is left out if it stays more than 10 m beyond the range
/// at every sixteenth of the times. It has no motion if it stands at all of those where it is at the tick; a
/// part that turns always has one, since it may have turned whole turns from one of those times to the next.
render::LidarTargets lidar_targets(const World& world, const TickContext& context, const SweepView& view);

}  // namespace greatx::sim
