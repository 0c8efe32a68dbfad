// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Tests rotors and wheels: parts of a node's model that turn on the node. The tests need no device.
#include <cmath>
#include <fstream>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/error.h"
#include "core/units.h"
#include "scene/generator/mesh/materials.h"
#include "scene/generator/mesh/scene_writer.h"
#include "sim/scenario/parse/load_scenario.h"
#include "sim/world/moment.h"
#include "tests/support/temporary_folder.h"

namespace greatx::sim {
namespace {

using ::testing::HasSubstr;

/// Returns a scenario with a drone that banks along a curve. Its model is turned, shifted and scaled on the
/// node, and has the given parts.
std::string flying(const std::string& parts, const std::string& trajectory = "") {
  return "greatx: 1\nname: test\nseed: 5\nticks: 40\ntick_rate_hz: 400\nscene: {origin_m: [10, 20, "
         "30]}\nnodes:\n"
         "  - name: uav\n    trajectory: " +
         (trajectory.empty()
              ? "{type: waypoints, points: [{t_s: 0, position_m: [-20, -15, 40], rotation_deg: [10, 0, 20]}, "
                "{t_s: 0.1, position_m: [-18, -14.5, 40.5], rotation_deg: [40, 15, -10]}]}"
              : trajectory) +
         "\n    model: {generate: {kind: quadrotor, variant: large}, position_m: [0.1, 0.2, -0.3], "
         "rotation_deg: [30, 10, 5], scale: [2, 2, -2]" +
         (parts.empty() ? "" : ", parts: [" + parts + "]") + "}\n";
}
const std::string four_rotors =
    "{nodes: [rotor_0, rotor_2], rpm: 5400, phase_deg: 20}, {nodes: \"rotor_[13]\", rate_hz: -90, phase_deg: "
    "20}";

struct Flight {
  explicit Flight(const std::string& yaml, uint32_t sequence = 0)
      : scenario(parse_scenario(yaml, "test.yaml", ".")),
        world(load_world(scenario)),
        courses(make_courses(scenario, world, sequence)) {}
  uint32_t body(const std::string& name) const { return world.scene.body_index(name); }
  Motion motion(const std::string& name, double time_s) const {
    return body_motion(world, courses, body(name), time_s);
  }
  /// Returns the turn of a part at tick 0, rad.
  double start(size_t part) const {
    const uint32_t node = world.node_of_body[world.parts[part].body];
    return courses.turns[part].at(courses.nodes[node]->travel(0.0), 0.0).value;
  }
  Scenario scenario;
  World world;
  Courses courses;
};

/// Returns the corners of an instance's triangles in its body's frame.
std::vector<dvec3> corners_of(const scene::Scene& scene, const std::string& instance) {
  std::vector<dvec3> corners;
  for (const scene::Primitive& primitive : scene.primitives)
    if (scene.instances[primitive.instance].name == instance)
      for (uint32_t i = 0; i < primitive.index_count; ++i)
        corners.emplace_back(scene.positions[scene.indices[primitive.first_index + i]]);
  return corners;
}

/// Turns `v` about `axis` by Rodrigues' formula.
dvec3 turned(const dvec3& v, const dvec3& axis, double angle) {
  return v * std::cos(angle) + glm::cross(axis, v) * std::sin(angle) +
         axis * glm::dot(axis, v) * (1.0 - std::cos(angle));
}

TEST(Parts, EveryCornerOfABladeIsWhereTheClosedFormHasIt) {
  const Flight whole(flying("")), parts(flying(four_rotors));
  ASSERT_EQ(whole.world.scene.bodies.size(), 2u);
  ASSERT_EQ(parts.world.scene.bodies.size(), 6u);
  const uint32_t uav = whole.body("uav");
  // The model's z axis on the node. The scale mirrors it.
  const dvec3 axis =
      orientation_from_yaw_pitch_roll(radians(30.0), radians(10.0), radians(5.0)) * dvec3(0, 0, -1);
  for (int rotor = 0; rotor < 4; ++rotor) {
    const std::string name = "uav/rotor_" + std::to_string(rotor);
    const std::vector<dvec3> rest = corners_of(whole.world.scene, name),
                             own = corners_of(parts.world.scene, name);
    ASSERT_GT(rest.size(), 50u);
    ASSERT_EQ(own.size(), rest.size());
    // Neighbouring rotors turn in opposite senses.
    const double side = rotor % 2 == 0 ? 1.0 : -1.0;
    const scene::Joint& joint = *parts.world.scene.bodies[parts.body(name)].joint;
    EXPECT_LT(glm::length(joint.axis - axis), 1e-15);
    for (const double time_s : {0.0, 0.0025, 0.0413, 0.1, 3600.0}) {
      const Pose carrier = body_motion(whole.world, whole.courses, uav, time_s).pose;
      const Pose blade = parts.motion(name, time_s).pose;
      const double turns = side * 90.0 * time_s + 20.0 / 360.0;
      const double angle = 2.0 * pi * (turns - std::floor(turns));
      for (size_t i = 0; i < rest.size(); ++i) {
        const dvec3 expected = carrier.apply(joint.position + turned(rest[i] - joint.position, axis, angle));
        ASSERT_LT(glm::length(blade.apply(own[i]) - expected), 1e-6) << name << ' ' << time_s;
      }
    }
  }
}

TEST(Parts, TurnAboutTheirOwnHub) {
  const Flight f(flying(four_rotors));
  // By scene/generator/objects/quadrotor.cpp the hubs lie on a circle of half the diagonal of 2.2 m, the
  // front left hub first. The model's mount comes on top.
  const Pose mount{dvec3(0.1, 0.2, -0.3),
                   orientation_from_yaw_pitch_roll(radians(30.0), radians(10.0), radians(5.0))};
  for (int rotor = 0; rotor < 4; ++rotor) {
    const double yaw = pi / 4 - pi / 2 * rotor;
    const dvec3 hub(1.1 * std::cos(yaw), 1.1 * std::sin(yaw), 0.044 * 2.2);
    const scene::Joint& joint = *f.world.scene.bodies[f.body("uav/rotor_" + std::to_string(rotor))].joint;
    EXPECT_LT(glm::length(joint.position - mount.apply(hub * dvec3(2, 2, -2))), 4e-3) << rotor;
  }
}

TEST(Parts, VelocitiesAreTheDerivativesOfPoses) {
  const Flight f(flying(four_rotors));
  constexpr double h = 1e-6, at_s = 0.0371;
  for (const std::string name : {"uav", "uav/rotor_0", "uav/rotor_3"}) {
    const Motion now = f.motion(name, at_s);
    for (const dvec3& point : {dvec3(0.0), dvec3(0.5, 0.0, 0.0), dvec3(-0.1, 0.4, 0.2)}) {
      const dvec3 slope =
          (f.motion(name, at_s + h).pose.apply(point) - f.motion(name, at_s - h).pose.apply(point)) /
          (2.0 * h);
      const dvec3 there = now.velocity + glm::cross(now.angular_velocity, now.pose.rotate(point));
      EXPECT_LT(glm::length(there - slope), 1e-4) << name;
      if (name == "uav" || point == dvec3(0.0)) continue;
      EXPECT_GT(glm::length(there), 100.0) << "of a tip";
    }
  }
}

TEST(Parts, OppositeRotorsCancelEachOthersTurn) {
  const Flight f(flying(four_rotors));
  for (const double time_s : {0.0, 0.0123, 0.08}) {
    const dvec3 left = f.motion("uav/rotor_0", time_s).angular_velocity,
                right = f.motion("uav/rotor_1", time_s).angular_velocity,
                carrier = f.motion("uav", time_s).angular_velocity;
    EXPECT_LT(glm::length(left + right - 2.0 * carrier), 1e-9);
    EXPECT_NEAR(glm::length(left - carrier), 2.0 * pi * 90.0, 1e-9);
    // Both rotors start alike and turn in the same sense, so their poses agree in rotation.
    const Pose a = f.motion("uav/rotor_0", time_s).pose, b = f.motion("uav/rotor_2", time_s).pose;
    EXPECT_LT(glm::length(a.rotate(dvec3(1, 0, 0)) - b.rotate(dvec3(1, 0, 0))), 1e-12) << "the same sense";
  }
}

TEST(Parts, StandAtTheirTickAsAtItsTime) {
  const Flight f(flying(four_rotors));
  const Clock clock(f.scenario.tick_rate_hz);
  for (const int64_t tick : {0, 7, 39}) {
    const Moment moment = moment_at(f.world, f.courses, clock, tick);
    for (uint32_t body = 0; body < 6; ++body) {
      const Pose pose = moment.context.body_pose_at(body, clock.seconds(tick));
      EXPECT_EQ(pose.position, moment.bodies[body].position);
      EXPECT_EQ(pose.orientation, moment.bodies[body].orientation);
    }
  }
}

TEST(Parts, StartsAreDrawnForEachOnItsOwn) {
  const std::string drawn = "{nodes: \"rotor_*\", rate_hz: 90}";
  const Flight first(flying(drawn)), again(flying(drawn)), other(flying(drawn), 1);
  std::vector<double> starts;
  for (uint32_t i = 0; i < 4; ++i) {
    const double start = first.start(i);
    EXPECT_EQ(start, again.start(i));
    EXPECT_NE(start, other.start(i));
    for (const double before : starts) EXPECT_NE(start, before);
    starts.push_back(start);
  }
  // Another list of parts does not change the parts that both lists contain.
  const Flight two(flying("{nodes: [rotor_3, rotor_1], rate_hz: 30}"));
  EXPECT_EQ(two.world.parts[0].name, "uav/rotor_1");
  EXPECT_EQ(two.start(0), starts[1]);
  EXPECT_EQ(two.start(1), starts[3]);
}

TEST(Parts, ReachHoldsEveryPlaceThatABladeComesTo) {
  const Flight f(flying(four_rotors));
  const uint32_t uav = f.body("uav");
  const scene::Bounds& reach = f.world.scene.reach_of(uav);
  EXPECT_TRUE(f.world.scene.bodies[f.body("uav/rotor_0")].reach.empty());
  scene::Bounds found = f.world.scene.bodies[uav].bounds;
  for (int rotor = 0; rotor < 4; ++rotor) {
    const std::string name = "uav/rotor_" + std::to_string(rotor);
    const scene::Joint& joint = *f.world.scene.bodies[f.body(name)].joint;
    for (const dvec3& corner : corners_of(f.world.scene, name))
      for (int i = 0; i < 720; ++i) found.add(joint.pose(2.0 * pi * i / 720).apply(corner));
  }
  // A turn in steps of half a degree misses the outermost point by r (1 - cos(0.25 deg)).
  for (int axis = 0; axis < 3; ++axis) {
    EXPECT_LE(reach.min[axis], found.min[axis] + 1e-12);
    EXPECT_GE(reach.max[axis], found.max[axis] - 1e-12);
    EXPECT_NEAR(reach.min[axis], found.min[axis], 2e-5);
    EXPECT_NEAR(reach.max[axis], found.max[axis], 2e-5);
  }
}

TEST(Parts, WithoutAnyTheSceneIsWhatItWas) {
  const Flight without(flying("")), parts(flying(four_rotors));
  EXPECT_EQ(without.world.scene.instances.size(), parts.world.scene.instances.size());
  for (size_t i = 0; i < without.world.scene.instances.size(); ++i)
    EXPECT_EQ(without.world.scene.instances[i].name, parts.world.scene.instances[i].name);
  EXPECT_EQ(without.world.scene.facets.size(), parts.world.scene.facets.size());
  EXPECT_NE(without.world.scene.hash, parts.world.scene.hash);
  // Another axis makes another scene, but another rate does not.
  EXPECT_NE(Flight(flying("{nodes: rotor_0, rate_hz: 9}")).world.scene.hash,
            Flight(flying("{nodes: rotor_0, rate_hz: 9, axis: [0, 1, 9]}")).world.scene.hash);
  EXPECT_EQ(Flight(flying("{nodes: rotor_0, rate_hz: 9}")).world.scene.hash,
            Flight(flying("{nodes: rotor_0, rate_hz: 8}")).world.scene.hash);
}

TEST(Parts, OfANodeThatStandsStillTurnAllTheSame) {
  const std::string rests = "{type: static, position_m: [1, 2, 3], rotation_deg: [90, 0, 0]}";
  const Flight without(flying("", rests)), parts(flying(four_rotors, rests));
  EXPECT_EQ(without.world.body_of_node[0], 0u);
  EXPECT_EQ(without.world.scene.bodies.size(), 1u);
  ASSERT_EQ(parts.world.scene.bodies.size(), 6u);
  const Motion hull = parts.motion("uav", 0.7), rotor = parts.motion("uav/rotor_1", 0.7);
  EXPECT_EQ(hull.pose.position, dvec3(1, 2, 3) - dvec3(10, 20, 30));
  EXPECT_EQ(hull.velocity, dvec3(0.0));
  EXPECT_EQ(rotor.velocity, dvec3(0.0));
  EXPECT_NEAR(glm::length(rotor.angular_velocity), 2.0 * pi * 90.0, 1e-9);
}

std::string message_of(const std::string& yaml) {
  try {
    Flight flight(yaml);
    return "accepted";
  } catch (const UserError& error) {
    return error.what();
  }
}

TEST(Parts, WhatTheModelDoesNotHaveIsSaid) {
  EXPECT_EQ(message_of(flying("{nodes: propeller, rate_hz: 9}")),
            "test.yaml:10: model.parts of node 'uav': expected a node of quadrotor.glb (quadrotor, rotor_0, "
            "rotor_1, "
            "rotor_2, rotor_3), found 'propeller'");
  EXPECT_THAT(message_of(flying("{nodes: [rotor_0, \"rotor_*\"], rate_hz: 9}")),
              HasSubstr("model.parts of node 'uav': expected every node once, found 'rotor_0' twice"));
}

/// The branch below a part turns with it, nodes without meshes may be parts, and equal names get numbers.
TEST(Parts, AreWholeBranchesOfTheModel) {
  using namespace scene::generator;
  SceneWriter writer;
  MeshBuilder cube;
  cube.box(material("motor_metal"), dvec3(-0.1), dvec3(0.1));
  const int mesh = writer.add_mesh("cube", cube);
  const int hull = writer.add_node({.name = "hull", .mesh = mesh});
  for (const double side : {-1.0, 1.0}) {
    const int hub = writer.add_node({.name = "wheel", .position = {1.0, side, 0.0}, .parent = hull});
    for (int spoke = 0; spoke < 2; ++spoke)
      writer.add_node({.name = "spoke", .mesh = mesh, .position = {0.5 - spoke, 0.0, 0.0}, .parent = hub});
  }
  const test::TemporaryFolder folder;
  const std::vector<std::byte> glb = writer.finish("cart");
  std::ofstream(folder.path() / "cart.glb", std::ios::binary)
      .write(reinterpret_cast<const char*>(glb.data()), static_cast<std::streamsize>(glb.size()));
  const Flight f(
      "greatx: 1\nname: test\nticks: 40\ntick_rate_hz: 100\nnodes:\n  - name: cart\n"
      "    trajectory: {type: static, position_m: [0, 0, 0]}\n    model: {file: " +
      (folder.path() / "cart.glb").string() +
      ", parts: [{nodes: wheel, axis: [0, 3, 0], rate_hz: 1, phase_deg: 0}]}\n");
  const scene::Scene& scene = f.world.scene;
  ASSERT_EQ(scene.bodies.size(), 4u);
  EXPECT_EQ(scene.bodies[2].name, "cart/wheel");
  EXPECT_EQ(scene.bodies[3].name, "cart/wheel_2");
  EXPECT_EQ(scene.bodies[3].joint->position, dvec3(1, 1, 0));
  EXPECT_EQ(scene.bodies[3].joint->axis, dvec3(0, 1, 0));
  ASSERT_EQ(scene.instances.size(), 5u);
  EXPECT_EQ(scene.instances[0].body, 1u);
  for (uint32_t i = 1; i < 5; ++i) EXPECT_EQ(scene.instances[i].body, i < 3 ? 2u : 3u);
  // A quarter turn about y maps x to -z, so the wheel's front spoke points down.
  const dvec3 spoke = scene.instances[3].bounds.center();
  EXPECT_NEAR(spoke.x, 0.5, 1e-6);
  const dvec3 there = f.motion("cart/wheel_2", 0.25).pose.apply(spoke) + scene.origin;
  EXPECT_LT(glm::length(there - dvec3(1.0, 1.0, -0.5)), 1e-6);
}

}  // namespace
}  // namespace greatx::sim
