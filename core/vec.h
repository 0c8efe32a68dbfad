// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Defines vectors and frames. The world is right-handed: x east, y north, z up, in metres. Sensor and body
// frames have x forward, y left, z up. The camera's optical frame has x right, y down, z forward. Matrices
// read right to left.
#pragma once

#include <glm/glm.hpp>
#include <glm/gtc/quaternion.hpp>

namespace greatx {

using glm::dmat3;
using glm::dmat4;
using glm::dquat;
using glm::dvec2;
using glm::dvec3;
using glm::dvec4;
using glm::ivec2;
using glm::mat4;
using glm::uvec2;
using glm::vec2;
using glm::vec3;
using glm::vec4;

/// Describes a rigid transform `parent_from_child`: p_parent = position + orientation * p_child.
struct Pose {
  dvec3 position{0.0};                    ///< metres
  dquat orientation{1.0, 0.0, 0.0, 0.0};  ///< unit, w x y z

  dvec3 apply(const dvec3& point) const { return position + orientation * point; }
  dvec3 rotate(const dvec3& direction) const { return orientation * direction; }
  Pose inverse() const {
    const dquat back = glm::conjugate(orientation);
    return {back * -position, back};
  }
};

/// Returns a_from_c = a_from_b * b_from_c.
inline Pose operator*(const Pose& a_from_b, const Pose& b_from_c) {
  return {a_from_b.apply(b_from_c.position), glm::normalize(a_from_b.orientation * b_from_c.orientation)};
}

/// Returns R_z(yaw) R_y(pitch) R_x(roll), radians (3GPP TR 38.901, eq. 7.1-4: alpha, beta, gamma).
inline dquat orientation_from_yaw_pitch_roll(double yaw, double pitch, double roll) {
  return glm::angleAxis(yaw, dvec3(0, 0, 1)) * glm::angleAxis(pitch, dvec3(0, 1, 0)) *
         glm::angleAxis(roll, dvec3(1, 0, 0));
}

/// Holds the pose of a body at an instant and its derivatives in the world frame.
struct Motion {
  Pose pose;
  dvec3 velocity{0.0};          ///< m/s
  dvec3 acceleration{0.0};      ///< m/s^2
  dvec3 angular_velocity{0.0};  ///< rad/s, world frame
};

}  // namespace greatx
