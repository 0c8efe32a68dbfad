// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "sim/navigation/inertial.h"

#include <cmath>

namespace greatx::navigation {

double normal_gravity(double latitude, double height_m) {
  constexpr double equator = 9.7803253359, k = 1.931852652458e-3, e2 = 6.69437999014e-3;
  constexpr double a = 6378137.0, f = 1.0 / 298.257223563, m = 3.449786506841e-3;
  const double s2 = std::sin(latitude) * std::sin(latitude);
  const double at_ellipsoid = equator * (1.0 + k * s2) / std::sqrt(1.0 - e2 * s2);
  const double h = height_m / a;
  return at_ellipsoid * (1.0 - 2.0 * (1.0 + f + m - 2.0 * f * s2) * h + 3.0 * h * h);
}

InertialFrame earth_frame(double latitude, double height_m, bool rotates) {
  InertialFrame frame;
  frame.gravity = {0.0, 0.0, -normal_gravity(latitude, height_m)};
  if (rotates) frame.rotation = earth_rate * dvec3(0.0, std::cos(latitude), std::sin(latitude));
  return frame;
}

Motion mounted(const Motion& body, const dvec3& angular_acceleration, const Pose& mount) {
  const dvec3 r = body.pose.rotate(mount.position), w = body.angular_velocity;
  Motion sensor;
  sensor.pose = body.pose * mount;
  sensor.velocity = body.velocity + glm::cross(w, r);
  sensor.acceleration =
      body.acceleration + glm::cross(angular_acceleration, r) + glm::cross(w, glm::cross(w, r));
  sensor.angular_velocity = w;
  return sensor;
}

Inertial instantaneous(const Motion& sensor, const InertialFrame& frame) {
  const dquat to_sensor = glm::conjugate(sensor.pose.orientation);
  const dvec3 coriolis = 2.0 * glm::cross(frame.rotation, sensor.velocity);
  return {to_sensor * (sensor.acceleration + coriolis - frame.gravity),
          to_sensor * (sensor.angular_velocity + frame.rotation)};
}

dvec3 rotation_vector(const dquat& rotation) {
  const dquat q = rotation.w < 0.0 ? -rotation : rotation;
  const dvec3 v(q.x, q.y, q.z);
  const double sine = glm::length(v);
  // angle / sin(angle / 2) near 0: 2 (1 + s^2 / 6 + ...), which needs no more below 1e-4.
  const double factor = sine < 1e-4 ? 2.0 * (1.0 + sine * sine / 6.0) : 2.0 * std::atan2(sine, q.w) / sine;
  return factor * v;
}

Inertial mean_over(const Motion& begin, const Motion& end, double interval_s, const InertialFrame& frame) {
  const dquat to_begin = glm::conjugate(begin.pose.orientation);
  const dvec3 turned = rotation_vector(to_begin * end.pose.orientation) / interval_s;
  const dvec3 middle_velocity = 0.5 * (begin.velocity + end.velocity);
  const dvec3 force = (end.velocity - begin.velocity) / interval_s - frame.gravity +
                      2.0 * glm::cross(frame.rotation, middle_velocity);
  const dquat middle = glm::slerp(begin.pose.orientation, end.pose.orientation, 0.5);
  return {to_begin * force, turned + glm::conjugate(middle) * frame.rotation};
}

dvec3 angular_acceleration(const std::function<Motion(double time_s)>& motion_at, double time_s,
                           double half_s) {
  const auto rate = [&](double at_s) { return motion_at(at_s).angular_velocity; };
  if (time_s >= half_s) return (rate(time_s + half_s) - rate(time_s - half_s)) / (2.0 * half_s);
  return (-3.0 * rate(time_s) + 4.0 * rate(time_s + half_s) - rate(time_s + 2.0 * half_s)) / (2.0 * half_s);
}

}  // namespace greatx::navigation
