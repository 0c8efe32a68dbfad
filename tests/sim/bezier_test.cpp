// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Tests Bezier trajectories with given and with drawn control points. Hard case 60: curves without a
// direction.
#include <array>
#include <cmath>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/sim/trajectory_support.h"

namespace greatx::sim {
namespace {

using ::testing::HasSubstr;
using namespace sim::testing;

BezierTrajectory bezier_of(const std::array<dvec3, 4>& points) {
  BezierTrajectory trajectory;
  trajectory.control_points = points;
  return trajectory;
}

BezierTrajectory drawn_bezier() {
  BezierTrajectory trajectory;
  trajectory.min_m = {-100, -50, 10};
  trajectory.max_m = {100, 50, 60};
  trajectory.offset_m = {20, 20, 5};
  return trajectory;
}

TEST(BezierPath, MatchesBernsteinInClosedForm) {
  const std::array<dvec3, 4> p = {dvec3(0, 0, 10), dvec3(10, 20, 12), dvec3(-5, 30, 20), dvec3(40, 10, 15)};
  const auto path = course_of(bezier_of(p));
  const double T = 10.0;
  EXPECT_FALSE(path->is_static());
  const Motion start = path->at(0), middle = path->at(5), end = path->at(T);
  EXPECT_EQ(start.pose.position, p[0]);
  expect_near(middle.pose.position, (p[0] + 3.0 * p[1] + 3.0 * p[2] + p[3]) / 8.0, 1e-13);
  expect_near(end.pose.position, p[3], 1e-13);
  expect_near(start.velocity, 3.0 * (p[1] - p[0]) / T, 1e-13);
  expect_near(middle.velocity, 0.75 * (p[3] + p[2] - p[1] - p[0]) / T, 1e-13);
  expect_near(end.velocity, 3.0 * (p[3] - p[2]) / T, 1e-13);
  expect_near(start.acceleration, 6.0 * (p[2] - 2.0 * p[1] + p[0]) / (T * T), 1e-13);
  expect_near(end.acceleration, 6.0 * (p[3] - 2.0 * p[2] + p[1]) / (T * T), 1e-13);
}

TEST(BezierPath, DerivativesMatchDifferences) {
  const auto path =
      course_of(bezier_of({dvec3(0, 0, 10), dvec3(10, 20, 12), dvec3(-5, 30, 20), dvec3(40, 10, 15)}));
  for (double t = 0.5; t < 10; t += 0.73) expect_derivatives(*path, t, 10.0);
}

TEST(BezierPath, LooksAlongItsVelocityWithoutRoll) {
  const auto path = course_of(drawn_bezier(), 3);
  for (double t = 0; t <= 10; t += 0.25) {
    const Motion motion = path->at(t);
    expect_near(forward(motion), glm::normalize(motion.velocity), 1e-12);
    EXPECT_NEAR(motion.pose.rotate({0, 1, 0}).z, 0.0, 1e-12);
  }
}

TEST(BezierPath, SpeedIsTheLimitOfDistanceOverTime) {
  const auto path = course_of(drawn_bezier(), 5);
  double previous = 1e300;
  for (const double dt : {0.1, 0.01, 0.001}) {
    const double error = glm::distance((path->at(4 + dt).pose.position - path->at(4).pose.position) / dt,
                                       path->at(4).velocity);
    EXPECT_LT(error, 0.11 * previous);  // the error is of first order in dt
    previous = error;
  }
}

TEST(BezierPath, EndsKeepToBoxAndDistanceForThousandSeeds) {
  BezierTrajectory bezier = drawn_bezier();
  bezier.reference_node = "bs";
  bezier.min_distance_m = 30;
  bezier.max_distance_m = 55;
  Scenario scenario = scenario_of(bezier);
  NodeConfig bs;
  bs.name = "bs";
  bs.trajectory = StaticTrajectory{{10, 0, 25}, {}};
  scenario.nodes.push_back(bs);
  for (uint64_t seed = 0; seed < 1000; ++seed) {
    scenario.seed = seed;
    const auto paths = make_node_courses(scenario, 0).courses;
    const std::array<dvec3, 2> ends = {paths[0]->at(0).pose.position, paths[0]->at(10).pose.position};
    for (const dvec3& p : ends) {
      const double distance = glm::distance(p, dvec3(10, 0, 25));
      ASSERT_TRUE(distance >= 30 - 1e-9 && distance <= 55 + 1e-9) << distance;
      ASSERT_TRUE(glm::all(glm::greaterThanEqual(p, bezier.min_m - 1e-9)));
      ASSERT_TRUE(glm::all(glm::lessThanEqual(p, bezier.max_m + 1e-9)));
    }
    // B'(0) = 3 (P1 - P0) / T gives the offsets of P1 and P2 from the chord: both are within their limits,
    // and they differ.
    const dvec3 offset1 = paths[0]->at(0).velocity * (10.0 / 3.0) - (ends[1] - ends[0]) / 3.0;
    const dvec3 offset2 = (ends[1] - ends[0]) / 3.0 - paths[0]->at(10).velocity * (10.0 / 3.0);
    for (const dvec3& offset : {offset1, offset2})
      ASSERT_TRUE(glm::all(glm::lessThanEqual(glm::abs(offset), bezier.offset_m + 1e-9)));
    ASSERT_GT(glm::distance(offset1, offset2), 1e-6);
  }
}

TEST(BezierPath, EndsAreUniformInTheBox) {
  // z-test of the mean of n uniform numbers, at 4.5 sigma (probability 7e-6) for each coordinate.
  const int n = 4000;
  dvec3 sum{0};
  for (uint64_t seed = 0; seed < n; ++seed) sum += course_of(drawn_bezier(), seed)->at(0).pose.position;
  const dvec3 z = (sum / double(n) - dvec3(0, 0, 35)) / (dvec3(200, 100, 50) / std::sqrt(12.0 * n));
  EXPECT_LT(std::abs(z.x), 4.5);
  EXPECT_LT(std::abs(z.y), 4.5);
  EXPECT_LT(std::abs(z.z), 4.5);
}

TEST(BezierPath, DependsOnSeedSequenceAndNameOnly) {
  const auto positions = [](const Scenario& scenario, uint32_t sequence, size_t node) {
    const auto path = std::move(make_node_courses(scenario, sequence).courses[node]);
    return std::array{path->at(0).pose.position, path->at(3.3).pose.position, path->at(10).pose.position};
  };
  const Scenario alone = scenario_of(drawn_bezier(), 42);
  const auto reference = positions(alone, 0, 0);
  EXPECT_EQ(positions(alone, 0, 0), reference);
  EXPECT_NE(positions(alone, 1, 0), reference);
  EXPECT_NE(positions(scenario_of(drawn_bezier(), 43), 0, 0), reference);
  Scenario crowd = alone;
  NodeConfig other = crowd.nodes[0];
  other.name = "b";
  crowd.nodes.insert(crowd.nodes.begin(), other);
  EXPECT_EQ(positions(crowd, 0, 1), reference);
  EXPECT_NE(positions(crowd, 0, 0), reference);
}

TEST(BezierPath, FollowsAMovingReferenceAtBothEnds) {
  BezierTrajectory bezier = drawn_bezier();
  bezier.reference_node = "car";
  bezier.max_distance_m = 40;
  Scenario scenario = scenario_of(bezier);
  NodeConfig car;
  car.name = "car";
  car.trajectory = way_points({{0, {-90, 0, 0}, {}}, {10, {90, 0, 0}, {}}});
  scenario.nodes.push_back(car);
  const auto paths = make_node_courses(scenario, 0).courses;
  for (const double t : {0.0, 10.0})
    EXPECT_LE(glm::distance(paths[0]->at(t).pose.position, paths[1]->at(t).pose.position), 40.0);
}

TEST(BezierPath, LimitsThatCannotBeMetNameTheNode) {
  BezierTrajectory bezier = drawn_bezier();
  bezier.reference_node = "bs";
  Scenario scenario = scenario_of(bezier);
  NodeConfig bs;
  bs.name = "bs";
  bs.trajectory = StaticTrajectory{{0, 0, 0}, {}};
  scenario.nodes.push_back(bs);
  const auto message = [&](double low, double high) -> std::string {
    std::get<BezierTrajectory>(scenario.nodes[0].trajectory).min_distance_m = low;
    std::get<BezierTrajectory>(scenario.nodes[0].trajectory).max_distance_m = high;
    try {
      make_node_courses(scenario, 0);
    } catch (const UserError& error) {
      return error.what();
    }
    return "accepted";
  };
  EXPECT_EQ(message(0, 9),
            "s.yaml:7: node 'a': expected a point of the box [-100, -50, 10] .. [100, 50, 60] m at 0 .. 9 m "
            "from 'bs' at "
            "[0, 0, 0] m, found distances of 10 .. 126.886 m only");
  EXPECT_THAT(message(127, 1e9), HasSubstr("only"));
  EXPECT_THAT(message(126.8857754, 126.8857754), HasSubstr("none in 100000 draws"));
  EXPECT_EQ(message(10, 126), "accepted");
}

TEST(BezierPath, GoesStraightOnBeyondTheRun) {
  const auto path = course_of(drawn_bezier(), 9);
  const Motion end = path->at(10), later = path->at(10.1);
  expect_near(later.velocity, end.velocity, 0.0);
  expect_near(later.pose.position, end.pose.position + 0.1 * end.velocity, 1e-12);
  EXPECT_EQ(later.pose.orientation, end.pose.orientation);
  EXPECT_EQ(later.acceleration, dvec3(0));
}

TEST(BezierPath, RunOfOneTickRestsAtTheStart) {
  Scenario scenario =
      scenario_of(bezier_of({dvec3(1, 2, 3), dvec3(2, 2, 3), dvec3(3, 2, 3), dvec3(4, 2, 3)}));
  scenario.ticks = 1;
  const auto paths = make_node_courses(scenario, 0).courses;
  for (const double t : {0.0, 0.05}) {
    const Motion motion = paths[0]->at(t);
    expect_finite(motion);
    EXPECT_EQ(motion.pose.position, dvec3(1, 2, 3));
    EXPECT_EQ(motion.velocity, dvec3(0));
  }
}

TEST(HardCase, N60_CoincidentControlPointsAtTheStart) {
  const dvec3 p(5, 5, 5);
  const auto path = course_of(bezier_of({p, p, p + dvec3(0, 3, 0), p + dvec3(3, 6, 0)}));
  const Motion start = path->at(0);
  expect_finite(start);
  EXPECT_EQ(start.velocity, dvec3(0));
  expect_near(forward(start), {0, 1, 0}, 1e-12);  // B'' = 6 (P2 - P0)
  // The attitude and its rate are the limits from after the start.
  expect_near(forward(path->at(1e-5)), forward(start), 1e-5);
  expect_near(path->at(1e-5).angular_velocity, start.angular_velocity, 1e-4);
  expect_near(forward(path->at(1e-11)), forward(start), 1e-8);
}

TEST(HardCase, N60_CoincidentControlPointsAtTheEnd) {
  const dvec3 p(500000.3, 5400000.7, 5);
  const auto path = course_of(bezier_of({p + dvec3(-9, -9, 0), p + dvec3(-3, 0, 0), p, p}));
  const Motion end = path->at(10);
  expect_finite(end);
  EXPECT_EQ(end.velocity, dvec3(0));
  expect_near(forward(end), {1, 0, 0}, 1e-9);  // the limit from before: -B'' = 6 (P3 - P1)
  expect_near(forward(path->at(10 - 1e-5)), forward(end), 1e-5);
}

TEST(HardCase, N60_ThreeCoincidentControlPoints) {
  const dvec3 p(5, 5, 5), q(5, 5 - 7, 5);
  for (const std::array<dvec3, 4>& points : {std::array{p, p, p, q}, std::array{p, q, q, q}}) {
    const auto path = course_of(bezier_of(points));
    for (const double t : {0.0, 1e-9, 1e-3, 5.0, 9.999, 10.0}) {
      const Motion motion = path->at(t);
      expect_finite(motion);
      expect_near(forward(motion), {0, -1, 0}, 1e-12);
    }
  }
}

TEST(HardCase, N60_CuspInTheMiddleKeepsTheAttitudeBefore) {
  // B' = 0 at u = 1/2. After it the curve goes straight back.
  const auto path = course_of(bezier_of({dvec3(0), dvec3(2, 0, 0), dvec3(2, 0, 0), dvec3(0)}));
  expect_near(forward(path->at(4.9)), {1, 0, 0}, 1e-12);
  expect_near(forward(path->at(5.0)), {1, 0, 0}, 1e-12);
  expect_near(forward(path->at(5.1)), {-1, 0, 0}, 1e-12);
  expect_finite(path->at(5.0));
}

TEST(HardCase, N60_ZeroLengthKeepsItsPose) {
  const dvec3 p(5, 6, 7);
  const auto path = course_of(bezier_of({p, p, p, p}));
  EXPECT_TRUE(path->is_static());
  for (const double t : {-1.0, 0.0, 5.0, 10.0, 11.0}) {
    const Motion motion = path->at(t);
    expect_finite(motion);
    EXPECT_EQ(motion.pose.position, p);
    EXPECT_EQ(motion.pose.orientation, dquat(1, 0, 0, 0));
    EXPECT_EQ(motion.velocity, dvec3(0));
    EXPECT_EQ(motion.angular_velocity, dvec3(0));
  }
}

}  // namespace
}  // namespace greatx::sim
