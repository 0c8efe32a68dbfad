// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Defines metadata that several sensors write.
#pragma once

#include <nlohmann/json.hpp>

#include "core/vec.h"

namespace greatx::sim {

/// Returns {"position_m": [x, y, z], "orientation_wxyz": [w, x, y, z]}.
inline nlohmann::json json_of(const Pose& pose) {
  const dquat& q = pose.orientation;
  return {{"position_m", {pose.position.x, pose.position.y, pose.position.z}},
          {"orientation_wxyz", {q.w, q.x, q.y, q.z}}};
}

}  // namespace greatx::sim
