// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Resolves directions and field vectors on the spherical basis of a frame: zenith theta from +z, azimuth phi
// = atan2(y, x) (3GPP TR 38.901, section 7.1).
#pragma once

#include <complex>

#include "core/dual.h"
#include "core/vec.h"

namespace greatx::rf {

using Complex = std::complex<double>;

/// Holds a field as amplitude gains (F_theta, F_phi); |F|^2 is a power gain.
struct Jones {
  Complex theta{0.0}, phi{0.0};
};

/// Holds the cosines and sines of a direction's angles. They are computed from the components, so that no
/// precision is lost near the poles. phi = 0 on the z axis.
template <typename R>
struct AnglesOf {
  R cos_theta, sin_theta, cos_phi, sin_phi;
  Vec3Of<R> theta_hat() const { return {cos_theta * cos_phi, cos_theta * sin_phi, -sin_theta}; }
  Vec3Of<R> phi_hat() const { return {-sin_phi, cos_phi, 0.0}; }
};
using Angles = AnglesOf<double>;
/// Returns the angles of `direction`, which need not be a unit vector but must not be zero.
template <typename R = double>
AnglesOf<R> angles_of(const Vec3Of<R>& direction);

/// Returns theta = atan2(hypot(x, y), z) and phi = atan2(y, x); phi = 0 on the z axis. `direction` need not
/// be a unit vector.
dvec2 theta_phi(const dvec3& direction);
/// Return the unit vectors theta-hat and phi-hat at a direction; at the poles, their limits along phi = 0.
template <typename R = double>
Vec3Of<R> theta_hat(const Vec3Of<R>& direction) {
  return angles_of<R>(direction).theta_hat();
}
template <typename R = double>
Vec3Of<R> phi_hat(const Vec3Of<R>& direction) {
  return angles_of<R>(direction).phi_hat();
}

}  // namespace greatx::rf
