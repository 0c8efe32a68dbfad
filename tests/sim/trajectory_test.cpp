// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "sim/scenario/trajectory.h"

#include <cmath>
#include <functional>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/units.h"
#include "sim/scenario/clock.h"

namespace greatx::sim {
namespace {

using testing::HasSubstr;

/// One node "a" for 10 s, unless told otherwise.
Scenario scenario_of(Trajectory trajectory, uint64_t seed = 1) {
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

std::unique_ptr<Path> path_of(Trajectory trajectory, uint64_t seed = 1, uint32_t sequence = 0) {
  return std::move(make_paths(scenario_of(std::move(trajectory), seed), sequence)[0]);
}

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

WayPointTrajectory way_points(std::vector<WayPoint> points, bool smooth = true) {
  return {std::move(points), smooth};
}

CorridorTrajectory corridor_of(int legs) {
  CorridorTrajectory trajectory;
  trajectory.center_line_m = {{0, 0, 20}, {100, 0, 20}, {100, 60, 40}};
  trajectory.width_m = 10;
  trajectory.height_m = 4;
  trajectory.legs = legs;
  return trajectory;
}

dvec3 forward(const Motion& motion) { return motion.pose.rotate({1, 0, 0}); }

void expect_near(const dvec3& actual, const dvec3& expected, double tolerance) {
  EXPECT_LE(glm::distance(actual, expected), tolerance)
      << "[" << actual.x << ", " << actual.y << ", " << actual.z << "] for [" << expected.x << ", "
      << expected.y << ", " << expected.z << "]";
}

void expect_finite(const Motion& m) {
  const dquat& q = m.pose.orientation;
  for (const dvec3& v :
       {m.pose.position, m.velocity, m.acceleration, m.angular_velocity, dvec3(q.x, q.y, q.z)})
    EXPECT_TRUE(std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z));
  EXPECT_NEAR(glm::length(q), 1.0, 1e-12);
}

/// Velocity, acceleration and angular velocity against central differences of the pose.
void expect_derivatives(const Path& path, double time_s, double scale) {
  SCOPED_TRACE(time_s);
  const double h = 1e-5;
  const Motion before = path.at(time_s - h), now = path.at(time_s), after = path.at(time_s + h);
  expect_near(now.velocity, (after.pose.position - before.pose.position) / (2 * h), 1e-7 * scale);
  expect_near(now.acceleration, (after.velocity - before.velocity) / (2 * h), 1e-7 * scale);
  const dquat turn = after.pose.orientation * glm::conjugate(before.pose.orientation);
  const double sign = turn.w < 0 ? -1.0 : 1.0;
  expect_near(now.angular_velocity, dvec3(turn.x, turn.y, turn.z) * (sign * 2.0 / (2 * h)), 1e-6 * scale);
}

// ------------------------------------------------------------------------------------------------------------ static

TEST(StaticPath, Rests) {
  const auto path = path_of(StaticTrajectory{{1, 2, 3}, {pi / 2, 0, 0}});
  EXPECT_TRUE(path->is_static());
  const Motion motion = path->at(5.0);
  EXPECT_EQ(motion.pose.position, dvec3(1, 2, 3));
  expect_near(forward(motion), {0, 1, 0}, 1e-15);
  EXPECT_EQ(motion.velocity, dvec3(0));
}

// ------------------------------------------------------------------------------------------------------------ Bezier

TEST(BezierPath, MatchesBernsteinInClosedForm) {
  const std::array<dvec3, 4> p = {dvec3(0, 0, 10), dvec3(10, 20, 12), dvec3(-5, 30, 20), dvec3(40, 10, 15)};
  const auto path = path_of(bezier_of(p));
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
      path_of(bezier_of({dvec3(0, 0, 10), dvec3(10, 20, 12), dvec3(-5, 30, 20), dvec3(40, 10, 15)}));
  for (double t = 0.5; t < 10; t += 0.73) expect_derivatives(*path, t, 10.0);
}

TEST(BezierPath, LooksAlongItsVelocityWithoutRoll) {
  const auto path = path_of(drawn_bezier(), 3);
  for (double t = 0; t <= 10; t += 0.25) {
    const Motion motion = path->at(t);
    expect_near(forward(motion), glm::normalize(motion.velocity), 1e-12);
    EXPECT_NEAR(motion.pose.rotate({0, 1, 0}).z, 0.0, 1e-12);
  }
}

TEST(BezierPath, SpeedIsTheLimitOfDistanceOverTime) {
  const auto path = path_of(drawn_bezier(), 5);
  double previous = 1e300;
  for (const double dt : {0.1, 0.01, 0.001}) {
    const double error = glm::distance((path->at(4 + dt).pose.position - path->at(4).pose.position) / dt,
                                       path->at(4).velocity);
    EXPECT_LT(error, 0.11 * previous);  // first order
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
    const auto paths = make_paths(scenario, 0);
    const std::array<dvec3, 2> ends = {paths[0]->at(0).pose.position, paths[0]->at(10).pose.position};
    for (const dvec3& p : ends) {
      const double distance = glm::distance(p, dvec3(10, 0, 25));
      ASSERT_TRUE(distance >= 30 - 1e-9 && distance <= 55 + 1e-9) << distance;
      ASSERT_TRUE(glm::all(glm::greaterThanEqual(p, bezier.min_m - 1e-9)));
      ASSERT_TRUE(glm::all(glm::lessThanEqual(p, bezier.max_m + 1e-9)));
    }
    // B'(0) = 3 (P1 - P0) / T: the offset at the middle is within its limits, and not always the same.
    const dvec3 offset1 = paths[0]->at(0).velocity * (10.0 / 3.0) - (ends[1] - ends[0]) / 3.0;
    const dvec3 offset2 = (ends[1] - ends[0]) / 3.0 - paths[0]->at(10).velocity * (10.0 / 3.0);
    for (const dvec3& offset : {offset1, offset2})
      ASSERT_TRUE(glm::all(glm::lessThanEqual(glm::abs(offset), bezier.offset_m + 1e-9)));
    ASSERT_GT(glm::distance(offset1, offset2), 1e-6);
  }
}

TEST(BezierPath, EndsAreUniformInTheBox) {
  // Mean of n uniform numbers: z-test at 4.5 sigma (7e-6) a coordinate.
  const int n = 4000;
  dvec3 sum{0};
  for (uint64_t seed = 0; seed < n; ++seed) sum += path_of(drawn_bezier(), seed)->at(0).pose.position;
  const dvec3 z = (sum / double(n) - dvec3(0, 0, 35)) / (dvec3(200, 100, 50) / std::sqrt(12.0 * n));
  EXPECT_LT(std::abs(z.x), 4.5);
  EXPECT_LT(std::abs(z.y), 4.5);
  EXPECT_LT(std::abs(z.z), 4.5);
}

TEST(BezierPath, DependsOnSeedSequenceAndNameOnly) {
  const auto positions = [](const Scenario& scenario, uint32_t sequence, size_t node) {
    const auto path = std::move(make_paths(scenario, sequence)[node]);
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
  const auto paths = make_paths(scenario, 0);
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
      make_paths(scenario, 0);
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
  const auto path = path_of(drawn_bezier(), 9);
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
  const auto paths = make_paths(scenario, 0);
  for (const double t : {0.0, 0.05}) {
    const Motion motion = paths[0]->at(t);
    expect_finite(motion);
    EXPECT_EQ(motion.pose.position, dvec3(1, 2, 3));
    EXPECT_EQ(motion.velocity, dvec3(0));
  }
}

// ------------------------------------------------------------------------------------------------------ hard case 60

TEST(HardCase, N60_CoincidentControlPointsAtTheStart) {
  const dvec3 p(5, 5, 5);
  const auto path = path_of(bezier_of({p, p, p + dvec3(0, 3, 0), p + dvec3(3, 6, 0)}));
  const Motion start = path->at(0);
  expect_finite(start);
  EXPECT_EQ(start.velocity, dvec3(0));
  expect_near(forward(start), {0, 1, 0}, 1e-12);  // B'' = 6 (P2 - P0)
  // The limit from after, in attitude and in its rate.
  expect_near(forward(path->at(1e-5)), forward(start), 1e-5);
  expect_near(path->at(1e-5).angular_velocity, start.angular_velocity, 1e-4);
  expect_near(forward(path->at(1e-11)), forward(start), 1e-8);
}

TEST(HardCase, N60_CoincidentControlPointsAtTheEnd) {
  const dvec3 p(500000.3, 5400000.7, 5);
  const auto path = path_of(bezier_of({p + dvec3(-9, -9, 0), p + dvec3(-3, 0, 0), p, p}));
  const Motion end = path->at(10);
  expect_finite(end);
  EXPECT_EQ(end.velocity, dvec3(0));
  expect_near(forward(end), {1, 0, 0}, 1e-9);  // from before: -B'' = 6 (P3 - P1)
  expect_near(forward(path->at(10 - 1e-5)), forward(end), 1e-5);
}

TEST(HardCase, N60_ThreeCoincidentControlPoints) {
  const dvec3 p(5, 5, 5), q(5, 5 - 7, 5);
  for (const std::array<dvec3, 4>& points : {std::array{p, p, p, q}, std::array{p, q, q, q}}) {
    const auto path = path_of(bezier_of(points));
    for (const double t : {0.0, 1e-9, 1e-3, 5.0, 9.999, 10.0}) {
      const Motion motion = path->at(t);
      expect_finite(motion);
      expect_near(forward(motion), {0, -1, 0}, 1e-12);
    }
  }
}

TEST(HardCase, N60_CuspInTheMiddleKeepsTheAttitudeBefore) {
  // B' = 0 at u = 1/2, then straight back.
  const auto path = path_of(bezier_of({dvec3(0), dvec3(2, 0, 0), dvec3(2, 0, 0), dvec3(0)}));
  expect_near(forward(path->at(4.9)), {1, 0, 0}, 1e-12);
  expect_near(forward(path->at(5.0)), {1, 0, 0}, 1e-12);
  expect_near(forward(path->at(5.1)), {-1, 0, 0}, 1e-12);
  expect_finite(path->at(5.0));
}

TEST(HardCase, N60_ZeroLengthKeepsItsPose) {
  const dvec3 p(5, 6, 7);
  const auto path = path_of(bezier_of({p, p, p, p}));
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

// ---------------------------------------------------------------------------------------------------------- attitude

TEST(Attitude, ClimbIsNegativePitchAndVerticalFlightKeepsYaw) {
  const double h = std::sqrt(0.5);
  const auto path = path_of(way_points({{0, {0, 0, 0}, {}},
                                        {1, {0, 1, 1}, {}},    // north, climbing at 45 degrees
                                        {2, {0, 1, 5}, {}},    // straight up
                                        {3, {0, 1, 5}, {}},    // hover
                                        {4, {0, 1, 0}, {}},    // straight down
                                        {5, {-2, 1, 0}, {}}},  // west
                                       false));
  expect_near(forward(path->at(0.5)), {0, h, h}, 1e-12);
  expect_near(forward(path->at(1.5)), {0, 0, 1}, 1e-12);
  expect_near(path->at(1.5).pose.rotate({0, 1, 0}), {-1, 0, 0}, 1e-12);  // left stays west: yaw is kept
  expect_near(forward(path->at(2.5)), {0, 0, 1}, 1e-12);                 // hover keeps the pose before
  expect_near(path->at(2.5).pose.rotate({0, 1, 0}), {-1, 0, 0}, 1e-12);
  expect_near(forward(path->at(3.5)), {0, 0, -1}, 1e-12);
  expect_near(path->at(3.5).pose.rotate({0, 1, 0}), {-1, 0, 0}, 1e-12);
  expect_near(forward(path->at(4.5)), {-1, 0, 0}, 1e-12);
}

TEST(Attitude, VerticalStartTakesTheYawThatFollows) {
  const auto path = path_of(way_points({{0, {0, 0, 0}, {}}, {1, {0, 0, 5}, {}}, {2, {0, 3, 5}, {}}}, false));
  expect_near(forward(path->at(0.5)), {0, 0, 1}, 1e-12);
  expect_near(path->at(0.5).pose.rotate({0, 1, 0}), {-1, 0, 0}, 1e-12);
}

TEST(Attitude, WhollyVerticalFlightIsFinite) {
  const auto path = path_of(way_points({{0, {0, 0, 0}, {}}, {1, {0, 0, 5}, {}}}));
  for (const double t : {0.0, 0.5, 1.0}) {
    expect_finite(path->at(t));
    expect_near(forward(path->at(t)), {0, 0, 1}, 1e-12);
  }
}

TEST(Attitude, SmoothDwellLooksWhereItCameFrom) {
  // Rests exactly at t = 1 .. 2: the Hermite tangents there are not zero, so give the dwell room on both sides.
  const auto path = path_of(way_points({{0, {0, 0, 0}, {}},
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
      path_of(way_points({{0, {0, 0, 0}, q(0)}, {2, {1, 0, 0}, q(pi / 2)}, {3, {2, 0, 0}, -q(pi)}}));
  expect_near(forward(path->at(1)), {std::sqrt(0.5), std::sqrt(0.5), 0}, 1e-12);
  expect_near(path->at(1).angular_velocity, {0, 0, pi / 4}, 1e-12);
  expect_near(path->at(2.5).angular_velocity, {0, 0, pi / 2},
              1e-12);  // the short way, though the sign differs
  expect_near(forward(path->at(3)), {-1, 0, 0}, 1e-12);
  expect_derivatives(*path, 0.7, 1.0);
  expect_derivatives(*path, 2.3, 1.0);
}

// --------------------------------------------------------------------------------------------------------- way-points

TEST(WayPointPath, PassesThroughItsPointsWithContinuousVelocity) {
  const std::vector<WayPoint> points = {
      {1, {0, 0, 10}, {}}, {2, {10, 3, 10}, {}}, {2.5, {12, 9, 14}, {}}, {6, {40, 9, 20}, {}}};
  const auto path = path_of(way_points(points));
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
  const auto path = path_of(way_points(points));
  for (double t = 0; t <= 5; t += 0.1) {
    expect_near(path->at(t).pose.position, p + v * t + 0.5 * a * t * t, 1e-12);
    expect_near(path->at(t).velocity, v + a * t, 1e-12);
    expect_near(path->at(t).acceleration, a, 1e-11);
  }
}

TEST(WayPointPath, LinearIsLinearAlsoFarFromTheOrigin) {
  const dvec3 far(691000.1, 5335000.7, 500);
  const auto path = path_of(way_points({{0, far, {}}, {2, far + dvec3(1, 3, 5), {}}}, false));
  expect_near(path->at(0.5).velocity, {0.5, 1.5, 2.5}, 1e-9);
  EXPECT_EQ(path->at(0.5).acceleration, dvec3(0));
  expect_near(path->at(0.5).pose.position, far + dvec3(0.25, 0.75, 1.25), 1e-9);
}

TEST(WayPointPath, HoldsBeforeAndAfter) {
  const auto path = path_of(way_points({{1, {0, 0, 0}, {}}, {2, {0, 4, 0}, {}}}));
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
  const auto path = path_of(way_points({{1, {3, 4, 5}, orientation_from_yaw_pitch_roll(pi / 2, 0, 0)}}));
  EXPECT_TRUE(path->is_static());
  EXPECT_EQ(path->at(0).pose.position, dvec3(3, 4, 5));
  expect_near(forward(path->at(0)), {0, 1, 0}, 1e-15);
}

TEST(WayPointPath, TurningOnTheSpotIsNotStatic) {
  const auto q = [](double yaw) { return orientation_from_yaw_pitch_roll(yaw, 0, 0); };
  EXPECT_FALSE(path_of(way_points({{0, {1, 1, 1}, q(0)}, {1, {1, 1, 1}, q(1)}}))->is_static());
  EXPECT_TRUE(path_of(way_points({{0, {1, 1, 1}, q(1)}, {1, {1, 1, 1}, q(1)}}))->is_static());
}

// ----------------------------------------------------------------------------------------------------------- corridor

/// Distance of `p` from the segment's axis across and up, if its foot lies on the segment.
bool within(const dvec3& p, const dvec3& a, const dvec3& b, double half_width, double half_height) {
  const dvec3 along = glm::normalize(b - a), across = glm::normalize(dvec3(-along.y, along.x, 0));
  const dvec3 up = glm::cross(along, across), d = p - a;
  return std::abs(glm::dot(d, across)) <= half_width + 1e-9 &&
         std::abs(glm::dot(d, up)) <= half_height + 1e-9;
}

TEST(CorridorPath, StaysInsideAtConstantSpeed) {
  for (uint64_t seed = 0; seed < 50; ++seed) {
    const CorridorTrajectory corridor = corridor_of(7);
    const auto path = path_of(corridor, seed);
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
  const auto path = path_of(corridor);
  const double second = std::sqrt(60.0 * 60 + 20 * 20), total = 100 + second;
  expect_near(path->at(0).pose.position, {0, 0, 20}, 1e-12);
  expect_near(path->at(10).pose.position, {100, 60, 40}, 1e-12);
  expect_near(path->at(10.0 * 50 / total).pose.position, {50, 0, 20}, 1e-9);
  expect_near(path->at(10.0 * (100 + 0.5 * second) / total).pose.position, {100, 30, 30}, 1e-9);
  EXPECT_NEAR(glm::length(path->at(3).velocity), total / 10, 1e-9);
}

TEST(CorridorPath, DependsOnSeedAndSequence) {
  const auto at = [](uint64_t seed, uint32_t sequence) {
    return path_of(corridor_of(5), seed, sequence)->at(4.2).pose.position;
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
  const auto path = path_of(corridor);
  for (double t = 0; t <= 10; t += 0.1) expect_finite(path->at(t));
}

}  // namespace
}  // namespace greatx::sim
