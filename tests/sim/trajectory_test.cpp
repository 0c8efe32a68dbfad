// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Tests trajectories at rest, through way-points and in corridors, and their attitudes.
#include "sim/scenario/trajectory.h"

#include <cmath>

#include <gtest/gtest.h>

#include "core/units.h"
#include "tests/sim/trajectory_support.h"

namespace greatx::sim {
namespace {

using namespace sim::testing;

TEST(StaticCourse, Rests) {
  const auto path = course_of(StaticTrajectory{{1, 2, 3}, {pi / 2, 0, 0}});
  EXPECT_TRUE(path->is_static());
  const Motion motion = path->at(5.0);
  EXPECT_EQ(motion.pose.position, dvec3(1, 2, 3));
  expect_near(forward(motion), {0, 1, 0}, 1e-15);
  EXPECT_EQ(motion.velocity, dvec3(0));
}

TEST(Attitude, ClimbIsNegativePitchAndVerticalFlightKeepsYaw) {
  const double h = std::sqrt(0.5);
  const auto path = course_of(way_points({{0, {0, 0, 0}, {}},
                                          {1, {0, 1, 1}, {}},    // north, climbing at 45 degrees
                                          {2, {0, 1, 5}, {}},    // straight up
                                          {3, {0, 1, 5}, {}},    // hover
                                          {4, {0, 1, 0}, {}},    // straight down
                                          {5, {-2, 1, 0}, {}}},  // west
                                         false));
  expect_near(forward(path->at(0.5)), {0, h, h}, 1e-12);
  expect_near(forward(path->at(1.5)), {0, 0, 1}, 1e-12);
  expect_near(path->at(1.5).pose.rotate({0, 1, 0}), {-1, 0, 0}, 1e-12);  // left stays west: the yaw is kept
  expect_near(forward(path->at(2.5)), {0, 0, 1}, 1e-12);                 // a hover keeps the previous pose
  expect_near(path->at(2.5).pose.rotate({0, 1, 0}), {-1, 0, 0}, 1e-12);
  expect_near(forward(path->at(3.5)), {0, 0, -1}, 1e-12);
  expect_near(path->at(3.5).pose.rotate({0, 1, 0}), {-1, 0, 0}, 1e-12);
  expect_near(forward(path->at(4.5)), {-1, 0, 0}, 1e-12);
}

TEST(Attitude, VerticalStartTakesTheYawThatFollows) {
  const auto path =
      course_of(way_points({{0, {0, 0, 0}, {}}, {1, {0, 0, 5}, {}}, {2, {0, 3, 5}, {}}}, false));
  expect_near(forward(path->at(0.5)), {0, 0, 1}, 1e-12);
  expect_near(path->at(0.5).pose.rotate({0, 1, 0}), {-1, 0, 0}, 1e-12);
}

TEST(Attitude, WhollyVerticalFlightIsFinite) {
  const auto path = course_of(way_points({{0, {0, 0, 0}, {}}, {1, {0, 0, 5}, {}}}));
  for (const double t : {0.0, 0.5, 1.0}) {
    expect_finite(path->at(t));
    expect_near(forward(path->at(t)), {0, 0, 1}, 1e-12);
  }
}

TEST(Attitude, SmoothDwellLooksWhereItCameFrom) {
  // The node rests exactly from t = 1 to 2. The Hermite tangents there are not zero, so the dwell needs room
  // on both sides.
  const auto path = course_of(way_points({{0, {0, 0, 0}, {}},
                                          {1, {0, 4, 0}, {}},
                                          {2, {0, 4, 0}, {}},
                                          {3, {0, 4, 0}, {}},
                                          {4, {0, 4, 0}, {}},
                                          {5, {4, 4, 0}, {}}}));
  for (double t = 0; t <= 5; t += 0.125) expect_finite(path->at(t));
  const Motion rest = path->at(2.5);
  EXPECT_LE(glm::length(rest.velocity), 1e-15);
  EXPECT_NEAR(std::abs(forward(rest).y), 1.0, 1e-12);
  EXPECT_EQ(path->at(2.25).pose.orientation, path->at(2.75).pose.orientation);
}

TEST(Attitude, GivenAttitudesAreSlerped) {
  const auto q = [](double yaw) { return orientation_from_yaw_pitch_roll(yaw, 0, 0); };
  const auto path =
      course_of(way_points({{0, {0, 0, 0}, q(0)}, {2, {1, 0, 0}, q(pi / 2)}, {3, {2, 0, 0}, -q(pi)}}));
  expect_near(forward(path->at(1)), {std::sqrt(0.5), std::sqrt(0.5), 0}, 1e-12);
  expect_near(path->at(1).angular_velocity, {0, 0, pi / 4}, 1e-12);
  // The rotation takes the short way, although the signs of the quaternions differ.
  expect_near(path->at(2.5).angular_velocity, {0, 0, pi / 2}, 1e-12);
  expect_near(forward(path->at(3)), {-1, 0, 0}, 1e-12);
  expect_derivatives(*path, 0.7, 1.0);
  expect_derivatives(*path, 2.3, 1.0);
}

TEST(WayPointPath, PassesThroughItsPointsWithContinuousVelocity) {
  const std::vector<WayPoint> points = {
      {1, {0, 0, 10}, {}}, {2, {10, 3, 10}, {}}, {2.5, {12, 9, 14}, {}}, {6, {40, 9, 20}, {}}};
  const auto path = course_of(way_points(points));
  for (const WayPoint& point : points)
    expect_near(path->at(point.time_s).pose.position, point.position_m, 1e-13);
  for (const double t : {2.0, 2.5})
    expect_near(path->at(t - 1e-9).velocity, path->at(t + 1e-9).velocity, 1e-6);
  for (const double t : {1.3, 2.2, 3.0, 5.9}) expect_derivatives(*path, t, 30.0);
}

TEST(WayPointPath, ConstantAccelerationIsExact) {
  const dvec3 p(3, -2, 10), v(5, 1, 0), a(-0.4, 0.8, 0.1);
  std::vector<WayPoint> points;
  for (const double t : {0.0, 0.4, 1.7, 2.0, 5.0}) points.push_back({t, p + v * t + 0.5 * a * t * t, {}});
  const auto path = course_of(way_points(points));
  for (double t = 0; t <= 5; t += 0.1) {
    expect_near(path->at(t).pose.position, p + v * t + 0.5 * a * t * t, 1e-12);
    expect_near(path->at(t).velocity, v + a * t, 1e-12);
    expect_near(path->at(t).acceleration, a, 1e-11);
  }
}

TEST(WayPointPath, LinearIsLinearAlsoFarFromTheOrigin) {
  const dvec3 far(691000.1, 5335000.7, 500);
  const auto path = course_of(way_points({{0, far, {}}, {2, far + dvec3(1, 3, 5), {}}}, false));
  expect_near(path->at(0.5).velocity, {0.5, 1.5, 2.5}, 1e-9);
  EXPECT_EQ(path->at(0.5).acceleration, dvec3(0));
  expect_near(path->at(0.5).pose.position, far + dvec3(0.25, 0.75, 1.25), 1e-9);
}

TEST(WayPointPath, HoldsBeforeAndAfter) {
  const auto path = course_of(way_points({{1, {0, 0, 0}, {}}, {2, {0, 4, 0}, {}}}));
  for (const auto& [time_s, position] : {std::pair{0.5, dvec3(0)}, std::pair{2.5, dvec3(0, 4, 0)}}) {
    const Motion motion = path->at(time_s);
    EXPECT_EQ(motion.pose.position, position);
    EXPECT_EQ(motion.velocity, dvec3(0));
    EXPECT_EQ(motion.acceleration, dvec3(0));
    EXPECT_EQ(motion.angular_velocity, dvec3(0));
    expect_near(forward(motion), {0, 1, 0}, 1e-12);
  }
}

TEST(WayPointPath, OnePointIsStatic) {
  const auto path = course_of(way_points({{1, {3, 4, 5}, orientation_from_yaw_pitch_roll(pi / 2, 0, 0)}}));
  EXPECT_TRUE(path->is_static());
  EXPECT_EQ(path->at(0).pose.position, dvec3(3, 4, 5));
  expect_near(forward(path->at(0)), {0, 1, 0}, 1e-15);
}

TEST(WayPointPath, TurningOnTheSpotIsNotStatic) {
  const auto q = [](double yaw) { return orientation_from_yaw_pitch_roll(yaw, 0, 0); };
  EXPECT_FALSE(course_of(way_points({{0, {1, 1, 1}, q(0)}, {1, {1, 1, 1}, q(1)}}))->is_static());
  EXPECT_TRUE(course_of(way_points({{0, {1, 1, 1}, q(1)}, {1, {1, 1, 1}, q(1)}}))->is_static());
}

CorridorTrajectory corridor_of(int legs) {
  CorridorTrajectory trajectory;
  trajectory.center_line_m = {{0, 0, 20}, {100, 0, 20}, {100, 60, 40}};
  trajectory.width_m = 10;
  trajectory.height_m = 4;
  trajectory.legs = legs;
  return trajectory;
}

/// Returns whether the distances of `p` from the segment's axis, across and up, are within the half sizes.
bool within(const dvec3& p, const dvec3& a, const dvec3& b, double half_width, double half_height) {
  const dvec3 along = glm::normalize(b - a), across = glm::normalize(dvec3(-along.y, along.x, 0));
  const dvec3 up = glm::cross(along, across), d = p - a;
  return std::abs(glm::dot(d, across)) <= half_width + 1e-9 &&
         std::abs(glm::dot(d, up)) <= half_height + 1e-9;
}

TEST(CorridorPath, StaysInsideAtConstantSpeed) {
  for (uint64_t seed = 0; seed < 50; ++seed) {
    const CorridorTrajectory corridor = corridor_of(7);
    const auto path = course_of(corridor, seed);
    const double speed = glm::length(path->at(0).velocity);
    for (double t = 0.005; t < 10; t += 0.05) {
      const Motion motion = path->at(t);
      ASSERT_NEAR(glm::length(motion.velocity), speed, 1e-9 * speed);
      ASSERT_EQ(motion.acceleration, dvec3(0));
      const auto& line = corridor.center_line_m;
      ASSERT_TRUE(within(motion.pose.position, line[0], line[1], 5, 2) ||
                  within(motion.pose.position, line[1], line[2], 5, 2))
          << seed << " " << t;
    }
  }
}

TEST(CorridorPath, WithoutWidthIsTheCentreLine) {
  CorridorTrajectory corridor = corridor_of(6);
  corridor.width_m = corridor.height_m = 0;
  const auto path = course_of(corridor);
  const double second = std::sqrt(60.0 * 60 + 20 * 20), total = 100 + second;
  expect_near(path->at(0).pose.position, {0, 0, 20}, 1e-12);
  expect_near(path->at(10).pose.position, {100, 60, 40}, 1e-12);
  expect_near(path->at(10.0 * 50 / total).pose.position, {50, 0, 20}, 1e-9);
  expect_near(path->at(10.0 * (100 + 0.5 * second) / total).pose.position, {100, 30, 30}, 1e-9);
  EXPECT_NEAR(glm::length(path->at(3).velocity), total / 10, 1e-9);
}

TEST(CorridorPath, DependsOnSeedAndSequence) {
  const auto at = [](uint64_t seed, uint32_t sequence) {
    return course_of(corridor_of(5), seed, sequence)->at(4.2).pose.position;
  };
  EXPECT_EQ(at(1, 0), at(1, 0));
  EXPECT_NE(at(1, 0), at(2, 0));
  EXPECT_NE(at(1, 0), at(1, 1));
}

TEST(CorridorPath, VerticalAndReversingCentreLinesAreFinite) {
  CorridorTrajectory corridor;
  corridor.width_m = corridor.height_m = 1;
  corridor.legs = 4;
  corridor.center_line_m = {{0, 0, 0}, {0, 0, 50}, {0, 0, 10}};
  const auto path = course_of(corridor);
  for (double t = 0; t <= 10; t += 0.1) expect_finite(path->at(t));
}

}  // namespace
}  // namespace greatx::sim
