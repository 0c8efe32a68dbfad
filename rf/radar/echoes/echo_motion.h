// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// How ends and bodies move while a radar frame lasts, and what a search for echoes met.
#pragma once

#include <cstdint>
#include <functional>
#include <vector>

#include "core/vec.h"

namespace greatx::rf {

/// Who moves how while a frame lasts. Times in seconds from the frame's start; poses in local coordinates.
struct EchoMotion {
  std::function<Pose(double time_s)> transmitter, receiver;
  /// Body 0 is never asked for. Must be the pose that the scene was traced with at `traced_s`.
  std::function<Pose(uint32_t body, double time_s)> body;
  double traced_s = 0.0;
  uint32_t first_slot = 0;
  std::vector<double> slot_start_s;  ///< [slots] of this list, ascending
  double slot_s = 0.0;               ///< the last slot's length
  double frame_s() const {
    return slot_start_s.empty() ? 0.0 : slot_start_s.back() + slot_s - slot_start_s.front();
  }
};

/// Everything as it is: what stands still.
EchoMotion at_rest(const Pose& transmitter, const Pose& receiver, const std::vector<Pose>& body_poses);

/// What a search met, for summaries.
struct EchoStatistics {
  uint32_t tubes = 0, target_tubes = 0;
  double target_tube_m = 0.0;   ///< width of tubes on targets that the budget allowed
  uint32_t mirror_tubes = 0;    ///< that were added on targets seen over mirrors
  double mirror_tube_m = 0.0;   ///< their width there
  uint64_t contributions = 0;   ///< before merging
  uint64_t below_floor = 0;     ///< edges and corners below EchoOptions::border_floor_m2
  uint64_t left_out = 0;        ///< echoes beyond EchoOptions::max_echoes
  double left_out_power = 0.0;  ///< their sum of |amplitude|^2
};

}  // namespace greatx::rf
