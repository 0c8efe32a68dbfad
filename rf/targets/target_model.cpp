// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "rf/targets/target_model.h"

#include <cmath>

namespace greatx::rf {
namespace {

/// Holds the rotation from components on the world's (theta, phi) at a direction to those on the target's.
struct Turn {
  double cos, sin;
  Turn(const dquat& orientation, const dvec3& world_direction) {
    const dvec3 theta = orientation * theta_hat(glm::conjugate(orientation) * world_direction);
    cos = glm::dot(theta, theta_hat(world_direction));
    sin = glm::dot(theta, phi_hat(world_direction));
  }
};

}  // namespace

ScatterMatrix transposed(const ScatterMatrix& s) { return {s[0], s[2], s[1], s[3]}; }

double Aspect::bistatic_angle() const {
  // Exact for small and for opposite directions alike.
  return 2.0 * std::atan2(glm::length(to_source - to_receiver), glm::length(to_source + to_receiver));
}

dvec3 Aspect::bisector() const {
  const dvec3 sum = to_source + to_receiver;
  const double length = glm::length(sum);
  return length > 1e-12 ? sum / length : to_source;
}

ScatterMatrix scatter_in_world(const TargetModel& model, const dquat& orientation, const Aspect& aspect,
                               const EchoKey& key) {
  const dquat back = glm::conjugate(orientation);
  const ScatterMatrix s = model.scatter(
      {back * aspect.to_source, back * aspect.to_receiver, aspect.source_m, aspect.receiver_m}, key);
  const Turn in(orientation, aspect.to_source), out(orientation, aspect.to_receiver);
  // S in = [cos sin; -sin cos] of the world's components, and the transpose of that going out.
  const Complex tt = s[0] * in.cos - s[1] * in.sin, tp = s[0] * in.sin + s[1] * in.cos,
                pt = s[2] * in.cos - s[3] * in.sin, pp = s[2] * in.sin + s[3] * in.cos;
  return {out.cos * tt - out.sin * pt, out.cos * tp - out.sin * pp, out.sin * tt + out.cos * pt,
          out.sin * tp + out.cos * pp};
}

}  // namespace greatx::rf
