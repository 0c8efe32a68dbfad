// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Computes what an inertial sensor without errors measures: specific force and angular rate in its own frame
// at its place on the body.
#pragma once

#include <functional>

#include "core/vec.h"

namespace greatx::navigation {

/// Standard gravity, m/s^2 (3rd CGPM, 1901).
inline constexpr double standard_gravity = 9.80665;
/// The Earth's rate of rotation, rad/s (WGS 84; NGA.STND.0036, table 3.1).
inline constexpr double earth_rate = 7.292115e-5;

/// Returns normal gravity at a height above the ellipsoid of WGS 84, m/s^2: Somigliana's formula at height 0
/// (NGA.STND.0036, eq. 4-1), and its second-order expansion in the height (eq. 4-3), which is exact to
/// 1e-6 m/s^2 up to 10 km.
double normal_gravity(double latitude, double height_m);

/// Holds the surroundings of an inertial sensor, in the axes of the world.
struct InertialFrame {
  dvec3 gravity{0.0, 0.0, -standard_gravity};  ///< m/s^2, downwards
  dvec3 rotation{0.0};  ///< of the world against the stars, rad/s; 0: the world counts as inertial
};

/// Returns the frame of a place on the Earth whose axes are east, north and up. `rotates`: with the Earth's
/// rotation.
InertialFrame earth_frame(double latitude, double height_m, bool rotates);

/// What the sensor measures, in its frame.
struct Inertial {
  dvec3 force{0.0};  ///< specific force f = a - g, m/s^2
  dvec3 rate{0.0};   ///< angular velocity, rad/s
};

/// Returns the motion of a point of the body that is `mount`ed at r: v + w x r, a + b x r + w x (w x r).
/// `angular_acceleration` b is in world axes. The pose is that of the sensor's frame.
Motion mounted(const Motion& body, const dvec3& angular_acceleration, const Pose& mount);

/// Returns the instantaneous measurement. With a rotation W of the world, the rate is w + W, and the specific
/// force has Coriolis' term 2 W x v (P. D. Groves, Principles of GNSS, Inertial, and Multisensor Integrated
/// Navigation Systems, 2nd ed. 2013, eq. 5.53); gravity has the centrifugal term already.
Inertial instantaneous(const Motion& sensor, const InertialFrame& frame);

/// Returns the mean over an interval, from the motions at its beginning and its end: the rotation between
/// them as a vector over the time, and the change of velocity less gravity's share over the time, in the
/// sensor's axes at the beginning. These are the increments that a strapdown computer makes with exact
/// corrections of coning and sculling, and those of pre-integration (C. Forster et al., "On-Manifold
/// Preintegration for Real-Time Visual-Inertial Odometry", IEEE Trans. Robotics 33 (2017), eq. 33). A
/// rotation of the world acts at the middle of the interval.
Inertial mean_over(const Motion& begin, const Motion& end, double interval_s, const InertialFrame& frame);

/// Returns the derivative of the angular velocity at `time_s` by central differences over `half_s` on each
/// side, or by one-sided ones of second order if that would begin before 0. Its error is of second order in
/// half_s; where the angular velocity jumps it is the mean over the interval.
dvec3 angular_acceleration(const std::function<Motion(double time_s)>& motion_at, double time_s,
                           double half_s);

/// Returns the rotation vector of a unit quaternion, at most pi long.
dvec3 rotation_vector(const dquat& rotation);

}  // namespace greatx::navigation
