// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Trajectories of one node, and checks of their motion.
#pragma once

#include <cmath>
#include <memory>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "sim/scenario/trajectory.h"

namespace greatx::sim::testing {

/// Returns a scenario of one node "a" that follows `trajectory` for 10 s.
inline Scenario scenario_of(Trajectory trajectory, uint64_t seed = 1) {
  Scenario scenario;
  scenario.seed = seed;
  scenario.tick_rate_hz = {100, 1};
  scenario.ticks = 1001;
  NodeConfig node;
  node.name = "a";
  node.trajectory = std::move(trajectory);
  node.where = {"s.yaml", 7};
  scenario.nodes.push_back(node);
  return scenario;
}

inline std::unique_ptr<Course> course_of(Trajectory trajectory, uint64_t seed = 1, uint32_t sequence = 0) {
  return std::move(make_node_courses(scenario_of(std::move(trajectory), seed), sequence).courses[0]);
}

inline WayPointTrajectory way_points(std::vector<WayPoint> points, bool smooth = true) {
  return {std::move(points), smooth};
}

inline dvec3 forward(const Motion& motion) { return motion.pose.rotate({1, 0, 0}); }

inline void expect_near(const dvec3& actual, const dvec3& expected, double tolerance) {
  EXPECT_LE(glm::distance(actual, expected), tolerance)
      << "[" << actual.x << ", " << actual.y << ", " << actual.z << "] for [" << expected.x << ", "
      << expected.y << ", " << expected.z << "]";
}

inline void expect_finite(const Motion& m) {
  const dquat& q = m.pose.orientation;
  for (const dvec3& v :
       {m.pose.position, m.velocity, m.acceleration, m.angular_velocity, dvec3(q.x, q.y, q.z)})
    EXPECT_TRUE(std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z));
  EXPECT_NEAR(glm::length(q), 1.0, 1e-12);
}

/// Compares velocity, acceleration and angular velocity with central differences of position, velocity and
/// orientation.
inline void expect_derivatives(const Course& path, double time_s, double scale) {
  SCOPED_TRACE(time_s);
  const double h = 1e-5;
  const Motion before = path.at(time_s - h), now = path.at(time_s), after = path.at(time_s + h);
  expect_near(now.velocity, (after.pose.position - before.pose.position) / (2 * h), 1e-7 * scale);
  expect_near(now.acceleration, (after.velocity - before.velocity) / (2 * h), 1e-7 * scale);
  const dquat turn = after.pose.orientation * glm::conjugate(before.pose.orientation);
  const double sign = turn.w < 0 ? -1.0 : 1.0;
  expect_near(now.angular_velocity, dvec3(turn.x, turn.y, turn.z) * (sign * 2.0 / (2 * h)), 1e-6 * scale);
}

}  // namespace greatx::sim::testing
