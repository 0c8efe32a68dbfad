// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// What an inertial sensor measures, compared with closed forms of motions.
#include "sim/navigation/inertial.h"

#include <cmath>

#include <gtest/gtest.h>

#include "core/units.h"

namespace greatx::navigation {
namespace {

void expect_near(const dvec3& found, const dvec3& expected, double tolerance) {
  for (int i = 0; i < 3; ++i) EXPECT_NEAR(found[i], expected[i], tolerance) << i;
}

/// A body on a circle about the origin that looks along its way, with the rate w, in a plane of height 0.
Motion on_circle(double radius_m, double rate, double time_s) {
  const double phase = rate * time_s, c = std::cos(phase), s = std::sin(phase);
  Motion motion;
  motion.pose = {radius_m * dvec3(c, s, 0.0), orientation_from_yaw_pitch_roll(phase + pi / 2.0, 0.0, 0.0)};
  motion.velocity = radius_m * rate * dvec3(-s, c, 0.0);
  motion.acceleration = -radius_m * rate * rate * dvec3(c, s, 0.0);
  motion.angular_velocity = {0.0, 0.0, rate};
  return motion;
}

TEST(Gravity, IsSomiglianasAtTheEllipsoidAndFallsWithHeight) {
  // Equator, pole and 45 degrees of WGS 84 (NGA.STND.0036, table 3.6: 9.7803253359 and 9.8321849379).
  EXPECT_NEAR(normal_gravity(0.0, 0.0), 9.7803253359, 1e-10);
  EXPECT_NEAR(normal_gravity(pi / 2.0, 0.0), 9.8321849379, 1e-9);
  EXPECT_NEAR(normal_gravity(pi / 4.0, 0.0), 9.8061978, 1e-7);
  // The free-air gradient is -3.086e-6 1/s^2 near 45 degrees.
  EXPECT_NEAR((normal_gravity(pi / 4.0, 10.0) - normal_gravity(pi / 4.0, 0.0)) / 10.0, -3.086e-6, 2e-9);
}

TEST(Inertial, ASensorAtRestMeasuresGravityUpwards) {
  Motion rest;
  const Inertial level = instantaneous(mounted(rest, dvec3(0.0), {}), {});
  expect_near(level.force, {0.0, 0.0, 9.80665}, 1e-15);
  expect_near(level.rate, dvec3(0.0), 0.0);
  // Rolled by 90 degrees, the y axis points up; pitched by 30 degrees nose down, x sees -g sin(30).
  rest.pose.orientation = orientation_from_yaw_pitch_roll(0.4, 0.0, pi / 2.0);
  expect_near(instantaneous(mounted(rest, dvec3(0.0), {}), {}).force, {0.0, 9.80665, 0.0}, 1e-14);
  rest.pose.orientation = orientation_from_yaw_pitch_roll(0.4, pi / 6.0, 0.0);
  expect_near(instantaneous(mounted(rest, dvec3(0.0), {}), {}).force,
              {-9.80665 * 0.5, 0.0, 9.80665 * std::sqrt(0.75)}, 1e-14);
  // In free fall it measures nothing.
  rest.acceleration = {0.0, 0.0, -9.80665};
  expect_near(instantaneous(mounted(rest, dvec3(0.0), {}), {}).force, dvec3(0.0), 1e-15);
}

TEST(Inertial, OnACircleItMeasuresTheCentripetalForceAndTheRateOfTurn) {
  constexpr double radius_m = 20.0, rate = 0.5;
  const Inertial found = instantaneous(mounted(on_circle(radius_m, rate, 3.1), dvec3(0.0), {}), {});
  // Turning left: the force points left with v^2 / r = r w^2.
  expect_near(found.force, {0.0, radius_m * rate * rate, 9.80665}, 1e-13);
  expect_near(found.rate, {0.0, 0.0, rate}, 1e-15);
}

TEST(Inertial, ALeverArmMovesTheSensorToAnotherCircle) {
  constexpr double radius_m = 20.0, rate = 0.5, lever_m = 3.0;
  // The lever points outwards (to the right of the way): the sensor is on a circle of 23 m.
  const Pose outside{{0.0, -lever_m, 0.0}, {1.0, 0.0, 0.0, 0.0}};
  const Motion sensor = mounted(on_circle(radius_m, rate, 1.7), dvec3(0.0), outside);
  const Motion there = on_circle(radius_m + lever_m, rate, 1.7);
  expect_near(sensor.pose.position, there.pose.position, 1e-13);
  expect_near(sensor.velocity, there.velocity, 1e-13);
  expect_near(sensor.acceleration, there.acceleration, 1e-13);
}

TEST(Inertial, ALeverArmSeesAngularAccelerationAndTheMountTurnsTheAxes) {
  Motion body;
  body.angular_velocity = {0.0, 0.0, 2.0};
  const dvec3 alpha(0.0, 0.0, 5.0);
  // At 0.3 m ahead: -w^2 r along x, alpha r along y.
  expect_near(instantaneous(mounted(body, alpha, {{0.3, 0.0, 0.0}, {1.0, 0.0, 0.0, 0.0}}), {}).force,
              {-1.2, 1.5, 9.80665}, 1e-14);
  // The same with the sensor's x axis to the left of the body.
  const Pose turned{{0.3, 0.0, 0.0}, orientation_from_yaw_pitch_roll(pi / 2.0, 0.0, 0.0)};
  expect_near(instantaneous(mounted(body, alpha, turned), {}).force, {1.5, 1.2, 9.80665}, 1e-14);
}

TEST(Inertial, MountedMotionIsTheDerivativeOfItsOwnPositions) {
  // A body that tumbles: compare with differences of positions of the mounted point.
  const auto body_at = [](double t) {
    Motion m;
    const double yaw = 0.3 * std::sin(1.1 * t), pitch = 0.2 * std::cos(0.7 * t),
                 roll = 0.4 * std::sin(0.5 * t);
    m.pose = {{std::sin(t), 2.0 * std::cos(0.5 * t), 0.1 * t * t},
              orientation_from_yaw_pitch_roll(yaw, pitch, roll)};
    m.velocity = {std::cos(t), -std::sin(0.5 * t), 0.2 * t};
    m.acceleration = {-std::sin(t), -0.5 * std::cos(0.5 * t), 0.2};
    const double dyaw = 0.33 * std::cos(1.1 * t), dpitch = -0.14 * std::sin(0.7 * t),
                 droll = 0.2 * std::cos(0.5 * t);
    const dquat z = glm::angleAxis(yaw, dvec3(0, 0, 1)), zy = z * glm::angleAxis(pitch, dvec3(0, 1, 0));
    m.angular_velocity =
        dyaw * dvec3(0, 0, 1) + dpitch * (z * dvec3(0, 1, 0)) + droll * (zy * dvec3(1, 0, 0));
    return m;
  };
  const Pose mount{{0.5, -0.2, 0.3}, orientation_from_yaw_pitch_roll(0.1, 0.2, -0.3)};
  constexpr double t = 2.3, h = 1e-3;
  const auto place = [&](double at) { return (body_at(at).pose * mount).position; };
  const dvec3 alpha = angular_acceleration(body_at, t, h);
  const Motion sensor = mounted(body_at(t), alpha, mount);
  expect_near(sensor.velocity, (place(t + h) - place(t - h)) / (2.0 * h), 1e-6);
  expect_near(sensor.acceleration, (place(t + h) - 2.0 * place(t) + place(t - h)) / (h * h), 1e-6);
  // At the beginning of a sequence the differences are one-sided, with an error of second order, too.
  expect_near(angular_acceleration(body_at, 0.0, h),
              (body_at(1e-5).angular_velocity - body_at(-1e-5).angular_velocity) / 2e-5, 1e-6);
}

TEST(Inertial, TheEarthsRotationAddsItsRateAndCoriolisForce) {
  const double latitude = radians(52.0);
  const InertialFrame frame = earth_frame(latitude, 100.0, true);
  EXPECT_NEAR(frame.gravity.z, -normal_gravity(latitude, 100.0), 0.0);
  const Inertial rest = instantaneous(Motion{}, frame);
  EXPECT_NEAR(glm::length(rest.rate), 7.292115e-5, 1e-12);
  EXPECT_NEAR(rest.rate.y, 7.292115e-5 * std::cos(latitude), 1e-12);
  // Eastwards at 100 m/s, the specific force upwards is less by 2 W v cos(latitude) (Eotvos).
  Motion east;
  east.velocity = {100.0, 0.0, 0.0};
  EXPECT_NEAR(instantaneous(east, frame).force.z - rest.force.z,
              -2.0 * 7.292115e-5 * 100.0 * std::cos(latitude), 1e-12);
  EXPECT_EQ(earth_frame(latitude, 100.0, false).rotation, dvec3(0.0));
}

TEST(Inertial, TheMeanRateIsTheRotationOverTheInterval) {
  // A coning motion: the axis circles, and the mean rate differs from the mean of instantaneous rates by the
  // cone's solid angle. The increments put together must give the final attitude exactly.
  const auto at = [](double t) {
    Motion m;
    const double cone = 0.1, w = 30.0;
    m.pose.orientation = glm::angleAxis(w * t, dvec3(0, 0, 1)) * glm::angleAxis(cone, dvec3(1, 0, 0)) *
                         glm::angleAxis(-w * t, dvec3(0, 0, 1));
    return m;
  };
  constexpr double step_s = 0.01;
  dquat attitude = at(0.0).pose.orientation;
  for (int i = 0; i < 100; ++i) {
    const Inertial mean = mean_over(at(i * step_s), at((i + 1) * step_s), step_s, {});
    const dvec3 angle = step_s * mean.rate;
    attitude = attitude * glm::angleAxis(glm::length(angle), glm::normalize(angle));
  }
  const dquat error = glm::conjugate(attitude) * at(1.0).pose.orientation;
  EXPECT_NEAR(glm::length(rotation_vector(error)), 0.0, 1e-12);
}

TEST(Inertial, TheMeanForceIntegratesToTheVelocity) {
  constexpr double radius_m = 20.0, rate = 0.5, step_s = 0.1;
  dvec3 velocity = on_circle(radius_m, rate, 0.0).velocity;
  for (int i = 0; i < 50; ++i) {
    const Motion begin = on_circle(radius_m, rate, i * step_s),
                 end = on_circle(radius_m, rate, (i + 1) * step_s);
    const Inertial mean = mean_over(begin, end, step_s, {});
    velocity += step_s * (begin.pose.orientation * mean.force + dvec3(0.0, 0.0, -9.80665));
  }
  expect_near(velocity, on_circle(radius_m, rate, 5.0).velocity, 1e-12);
}

TEST(RotationVector, IsTheAxisTimesTheAngle) {
  const dvec3 axis = glm::normalize(dvec3(1.0, -2.0, 0.5));
  for (const double angle : {0.0, 1e-12, 1e-5, 1e-3, 1.0, 3.1}) {
    expect_near(rotation_vector(glm::angleAxis(angle, axis)), angle * axis, 1e-14 + 1e-12 * angle);
    expect_near(rotation_vector(-glm::angleAxis(angle, axis)), angle * axis, 1e-14 + 1e-12 * angle);
  }
}

}  // namespace
}  // namespace greatx::navigation
