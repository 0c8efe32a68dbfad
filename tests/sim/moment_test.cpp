// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Tests where bodies are at the tick and at any other time.
#include "sim/world/moment.h"

#include <filesystem>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "core/error.h"
#include "sim/scenario/parse/load_scenario.h"

namespace greatx::sim {
namespace {

/// Nodes without a mesh stand before and between those with one, so that bodies and nodes have different
/// numbers.
constexpr const char* three_nodes = R"(greatx: 1
name: test
seed: 5
ticks: 40
tick_rate_hz: 30000/1001
scene: {generate: {kind: room}, origin_m: [100, -20, 3]}
nodes:
  - {name: bare, trajectory: {type: static, position_m: [1, 2, 1]}}
  - name: car
    trajectory: {type: waypoints, points: [{t_s: 0, position_m: [-2, -15, 0]}, )"
                                    R"({t_s: 1, position_m: [9, 2, 0]}]}
    model: {generate: {kind: car, variant: hatchback}, position_m: [0, 0, 0.5]}
  - {name: post, trajectory: {type: static, position_m: [1, 2, 1]}, model: {generate: {kind: mast}}}
  - name: uav
    trajectory: {type: bezier, control_points_m: [[0, 0, 1], [1, 0, 1], [2, 1, 1], [3, 1, 1]]}
    model: {generate: {kind: quadrotor}}
)";

bool same_bits(const Pose& a, const Pose& b) {
  return a.position == b.position && a.orientation == b.orientation;
}

TEST(Moment, BodiesAtTheTicksOwnTimeAreThoseOfTheTickToTheBit) {
  const Scenario scenario = parse_scenario(three_nodes, "test.yaml", ".");
  const World world = load_world(scenario);
  ASSERT_EQ(world.scene.bodies.size(), 3u);
  const Courses courses = make_courses(scenario, world, 0);
  const Clock clock(scenario.tick_rate_hz);
  for (const int64_t tick : {0, 7, 39}) {
    const Moment moment = moment_at(world, courses, clock, tick), other = moment_at(world, courses, clock, 3);
    for (uint32_t body = 0; body < world.scene.bodies.size(); ++body) {
      EXPECT_TRUE(same_bits(moment.context.body_pose_at(body, clock.seconds(tick)), moment.bodies[body]));
      // The result does not depend on the tick that asks.
      EXPECT_TRUE(same_bits(other.context.body_pose_at(body, clock.seconds(tick)), moment.bodies[body]));
    }
  }
}

/// Models are loaded on all cores, and chance decides which of them fails first.
TEST(LoadWorld, TheFirstFaultInTheScenariosOrderIsReported) {
  const Scenario sound = parse_scenario(three_nodes, "test.yaml", ".");
  for (int round = 0; round < 20; ++round) {
    Scenario scenario = sound;
    scenario.nodes[1].model->source = std::filesystem::path("/no/such/car.glb");
    scenario.nodes[3].model->source = std::filesystem::path("/no/such/uav.glb");
    try {
      load_world(scenario);
      FAIL() << "no error";
    } catch (const UserError& error) {
      EXPECT_NE(std::string(error.what()).find("car.glb"), std::string::npos) << error.what();
    }
  }
}

TEST(LoadWorld, NodesWithTheSameGeneratedModelShareIt) {
  const Scenario scenario =
      parse_scenario(R"(greatx: 1
name: test
ticks: 2
tick_rate_hz: 10
scene: {generate: {kind: room}}
nodes:
  - {name: a, trajectory: {type: waypoints, points: [{t_s: 0, position_m: [0, 0, 1]}, )"
                     R"({t_s: 1, position_m: [1, 0, 1]}]}, model: {generate: {kind: car}}}
  - {name: b, trajectory: {type: waypoints, points: [{t_s: 0, position_m: [0, 3, 1]}, )"
                     R"({t_s: 1, position_m: [1, 3, 1]}]}, model: {generate: {kind: car}}}
)",
                     "test.yaml", ".");
  const World world = load_world(scenario);
  ASSERT_EQ(world.scene.bodies.size(), 3u);
  EXPECT_EQ(world.body_of_node, (std::vector<uint32_t>{1, 2}));
  EXPECT_EQ(world.scene.bodies[1].primitive_count, world.scene.bodies[2].primitive_count);
  EXPECT_GT(world.scene.bodies[1].primitive_count, 0u);
}

TEST(Moment, BodiesFollowTheirNodesBetweenTicks) {
  const Scenario scenario = parse_scenario(three_nodes, "test.yaml", ".");
  const World world = load_world(scenario);
  const Courses courses = make_courses(scenario, world, 0);
  const Moment moment = moment_at(world, courses, Clock(scenario.tick_rate_hz), 10);
  EXPECT_TRUE(same_bits(moment.context.body_pose_at(0, 0.1234), Pose{}));
  for (const auto& [name, node] : {std::pair{"car", 1u}, {"uav", 3u}}) {
    const uint32_t body = world.scene.body_index(name);
    const Motion there = courses.nodes[node]->at(0.1234), found = moment.context.body_motion_at(body, 0.1234);
    EXPECT_EQ(found.pose.position, there.pose.position - dvec3(100, -20, 3)) << name;
    EXPECT_EQ(found.pose.orientation, there.pose.orientation) << name;
    EXPECT_EQ(found.velocity, there.velocity) << name;
    EXPECT_EQ(found.angular_velocity, there.angular_velocity) << name;
    EXPECT_FALSE(same_bits(found.pose, moment.bodies[body])) << name;
  }
}

}  // namespace
}  // namespace greatx::sim
