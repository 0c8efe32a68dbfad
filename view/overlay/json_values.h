// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Values that the metadata of several sensors hold.
#pragma once

#include <cmath>
#include <vector>

#include "core/vec.h"
#include "io/files/untrusted_json.h"

namespace greatx::view {

inline constexpr double farthest_m = 1e12;

/// The member `key`, or `otherwise` if it is not there. Throws UserError if it is no number in the range.
inline double number_or(const io::JsonValue& json, const char* key, double otherwise, double least,
                        double most) {
  return json.has(key) ? json.at(key).number(least, most) : otherwise;
}

inline dvec3 vector_of(const io::JsonValue& json) {
  const std::vector<io::JsonValue> xyz = json.tuple(3);
  const auto metres = [&](size_t axis) { return xyz[axis].number(-farthest_m, farthest_m); };
  return {metres(0), metres(1), metres(2)};
}

/// {"position_m": [3], "orientation_wxyz": [4]}; what is missing is that of the identity.
inline Pose pose_of_json(const io::JsonValue& json) {
  Pose pose;
  if (json.has("position_m")) pose.position = vector_of(json.at("position_m"));
  if (!json.has("orientation_wxyz")) return pose;
  const std::vector<io::JsonValue> q = json.at("orientation_wxyz").tuple(4);
  const auto part = [&](size_t i) { return q[i].number(-1.01, 1.01); };
  const dquat turn(part(0), part(1), part(2), part(3));
  if (!(std::abs(glm::length(turn) - 1.0) < 0.01)) json.at("orientation_wxyz").fail("a unit quaternion");
  pose.orientation = glm::normalize(turn);
  return pose;
}

}  // namespace greatx::view
