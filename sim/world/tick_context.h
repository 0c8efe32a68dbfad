// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Defines the places of everything at the tick that is being recorded, and at any other time.
#pragma once

#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include "core/vec.h"
#include "sim/scenario/scenario.h"

namespace greatx::sim {

/// Holds everything that a sensor may know of the tick that is being recorded.
struct TickContext {
  int64_t tick = 0;
  uint32_t sequence = 0;  ///< number of the sequence in the run
  double time_s = 0.0;
  /// The time of the previous tick at which something was due; NaN at the first one of a sequence.
  double previous_time_s = 0.0;
  std::span<const Motion> nodes;     ///< world frame, by node
  std::span<const Pose> body_poses;  ///< local coordinates, by body
  /// Returns the motion of any node at any other time (for a sweep's shots).
  std::function<Motion(uint32_t node, double time_s)> motion_at;
  /// Returns the motion of any body at any other time: the pose in local coordinates, and the derivatives of
  /// the body's origin (same axes). Body 0 stands still at the identity. At time_s the poses are those of
  /// body_poses, to the bit.
  std::function<Motion(uint32_t body, double time_s)> body_motion_at;
  /// Returns the poses of all bodies at any other time, as body_motion_at() does one by one; empty: not
  /// given.
  std::function<std::vector<Pose>(double time_s)> body_poses_of;
  /// Returns the factors of the scene's switched lamps (sim/world/lamps.h) at any time; empty: it has none.
  std::function<std::vector<float>(double time_s)> lamps_at;
  Pose body_pose_at(uint32_t body, double at_s) const { return body_motion_at(body, at_s).pose; }
  /// Returns the poses of all bodies.
  std::vector<Pose> body_poses_at(double at_s) const {
    if (at_s == time_s) return {body_poses.begin(), body_poses.end()};
    if (body_poses_of) return body_poses_of(at_s);
    std::vector<Pose> poses;
    for (uint32_t body = 0; body < body_poses.size(); ++body) poses.push_back(body_pose_at(body, at_s));
    return poses;
  }
};

/// Returns a mount as a pose: the transform from the sensor's frame to the frame of its node.
inline Pose mount_pose(const Mount& mount) {
  return {mount.position_m,
          orientation_from_yaw_pitch_roll(mount.rotation.x, mount.rotation.y, mount.rotation.z)};
}

}  // namespace greatx::sim
