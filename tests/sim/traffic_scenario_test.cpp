// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Traffic as scenarios ask for it: the key, its errors, recorded trajectories, bodies and their motions.
#include <cmath>
#include <fstream>
#include <set>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/units.h"
#include "scene/generator/objects/shapes.h"
#include "sim/scenario/parse/load_scenario.h"
#include "sim/scenario/parse/traffic_fcd.h"
#include "sim/world/moment.h"
#include "tests/support/temporary_folder.h"

namespace greatx::sim {
namespace {

using testing::HasSubstr;
using Kind = TrafficMember::Kind;

std::string city(const std::string& traffic, const std::string& rest = "") {
  return "greatx: 1\nname: test\nseed: 3\nticks: 100\ntick_rate_hz: 10\n"
         "scene: {generate: {kind: city, size_m: 300}}\ntraffic: " +
         traffic + "\n" + rest;
}

std::string message_of(const std::string& yaml) {
  try {
    parse_scenario(yaml, "test.yaml", ".", "");
    return "accepted";
  } catch (const UserError& error) {
    return error.what();
  }
}

TEST(TrafficScenario, MakesANodeOfEveryone) {
  const Scenario scenario =
      parse_scenario(city("{vehicles: 3, cyclists: 2, pedestrians: 4, seed: 9}",
                          "nodes: [{name: mast, trajectory: {type: static, position_m: [0, 0, 0]}}]\n"),
                     "test.yaml", ".", "");
  ASSERT_EQ(scenario.nodes.size(), 10u);
  EXPECT_EQ(scenario.nodes[0].name, "mast");
  EXPECT_EQ(scenario.nodes[1].name, "vehicle_000");
  EXPECT_EQ(scenario.nodes[4].name, "cyclist_000");
  EXPECT_EQ(scenario.nodes[9].name, "pedestrian_003");
  EXPECT_EQ(std::get<Generated>(scenario.nodes[9].model->source).kind, "person");
  EXPECT_EQ(scenario.traffic->members.size(), 9u);
  EXPECT_EQ(scenario.traffic->seed, 9u);
  // More of one kind change nothing of those before.
  const Scenario more =
      parse_scenario(city("{vehicles: 3, cyclists: 2, pedestrians: 40, seed: 9}"), "", ".", "");
  for (size_t i = 0; i < 9; ++i) {
    EXPECT_EQ(scenario.traffic->members[i], more.traffic->members[i]);
    EXPECT_EQ(scenario.nodes[i + 1].model->source, more.nodes[i].model->source);
  }
}

TEST(TrafficScenario, DrawsFromItsMix) {
  const Scenario scenario =
      parse_scenario(city("{vehicles: 400, mix: {taxi: 3, suv: 1, bicycle: 1}}"), "test.yaml", ".", "");
  int taxis = 0;
  for (const TrafficMember& member : scenario.traffic->members) {
    EXPECT_TRUE(member.variant == "taxi" || member.variant == "suv") << member.variant;
    taxis += member.variant == "taxi" ? 1 : 0;
  }
  EXPECT_NEAR(taxis, 300, 40);  // 4.6 standard deviations
}

/// Few streets of other scenes are wide enough for buses.
TEST(TrafficScenario, LongVehiclesAreOfGeneratedCitiesAlone) {
  const auto longest = [](const std::string& text) {
    double most_m = 0.0;
    const Scenario scenario = parse_scenario(text, "test.yaml", ".", "");
    for (const TrafficMember& member : scenario.traffic->members)
      for (const TrafficVariant& variant : traffic_variants())
        if (variant.name == member.variant) most_m = std::max(most_m, variant.length_m);
    return most_m;
  };
  const std::string text = city("{vehicles: 400}");
  EXPECT_EQ(longest(text), 12.0) << "a bus";
  const size_t kind = text.find("kind: city");
  ASSERT_NE(kind, std::string::npos);
  EXPECT_LE(longest(std::string(text).replace(kind, 10, "kind: canyon")), 6.0);
}

TEST(TrafficScenario, RefusesWhatIsWrong) {
  EXPECT_THAT(message_of(city("{vehicles: -1}")), HasSubstr("test.yaml:7: traffic.vehicles: expected"));
  EXPECT_THAT(message_of(city("{cars: 1}")), HasSubstr("traffic.cars"));
  EXPECT_THAT(message_of(city("{vehicles: 1, mix: {saloom: 1}}")), HasSubstr("saloom"));
  EXPECT_THAT(message_of(city("{vehicles: 1, fcd: x.xml}")), HasSubstr("traffic"));
  EXPECT_THAT(message_of(city("{vehicles: 1, warm_up_s: -1}")), HasSubstr("traffic.warm_up_s"));
  EXPECT_THAT(message_of(city("{vehicles: 1, types: {a: van}}")),
              HasSubstr("expected a 'fcd' or 'xosc' beside it"));
  EXPECT_THAT(message_of(city("{vehicles: 1}",
                              "nodes: [{name: vehicle_000, trajectory: {type: static, "
                              "position_m: [0, 0, 0]}}]\n")),
              HasSubstr("expected a name that nothing of the traffic has, found 'vehicle_000'"));
  EXPECT_THAT(message_of(city("{vehicles: 1}",
                              "nodes: [{name: cam, trajectory: {type: follow, node: "
                              "vehicle_001}}]\n")),
              HasSubstr("expected a node's name, found unknown 'vehicle_001'"));
}

/// The table of variants is the generator's.
TEST(TrafficScenario, KnowsTheGeneratorsVariants) {
  std::set<std::string> vehicles, people;
  for (const TrafficVariant& variant : traffic_variants()) {
    (variant.kind == Kind::pedestrian ? people : vehicles).insert(variant.name);
    if (variant.kind == Kind::pedestrian) continue;
    const scene::VehicleShape& shape = scene::vehicle_shape(variant.name);
    EXPECT_EQ(shape.length_m, variant.length_m) << variant.name;
    EXPECT_TRUE(variant.kind != Kind::cyclist || shape.two_wheeler);
  }
  EXPECT_EQ(vehicles.size(), scene::vehicle_shapes().size());
  EXPECT_EQ(people.size(), scene::person_shapes().size());
  for (const scene::PersonShape& shape : scene::person_shapes()) EXPECT_TRUE(people.contains(shape.variant));
}

// ------------------------------------------------------------------------------------------------- recorded

const char* const fcd = R"(<?xml version="1.0"?>
<fcd-export>
  <timestep time="0.00">
    <vehicle id="a" x="10" y="20" angle="90" speed="10" type="passenger"/>
    <person id="p" x="1" y="2" angle="0" speed="1"/>
  </timestep>
  <timestep time="1.00">
    <vehicle id="a" x="20" y="20" angle="90" speed="10" type="passenger"/>
  </timestep>
  <timestep time="2.00">
    <vehicle id="a" x="30" y="20" angle="90" speed="10" type="passenger"/>
    <vehicle id="b/1" x="0" y="0" angle="180" speed="5" type="my_bus"/>
  </timestep>
  <timestep time="3.00"/>
  <timestep time="4.00">
    <vehicle id="a" x="50" y="20" angle="0" speed="10" type="passenger"/>
  </timestep>
</fcd-export>
)";

TEST(RecordedTraffic, ReadsFloatingCarData) {
  const std::vector<RecordedTrack> tracks = parse_fcd(fcd, "run.xml", {dvec3(100.0, 0.0, 0.5), 1.0, {}});
  ASSERT_EQ(tracks.size(), 3u);
  EXPECT_EQ(tracks[0].id, "a");
  EXPECT_EQ(tracks[0].variant, "compact");
  EXPECT_EQ(tracks[1].kind, Kind::pedestrian);
  EXPECT_EQ(tracks[2].variant, "city_bus");
  EXPECT_EQ(tracks[2].where.line, 12);
  ASSERT_EQ(tracks[0].stretches.size(), 2u);
  const std::vector<WayPoint>& points = tracks[0].stretches[0].points;
  ASSERT_EQ(points.size(), 3u);
  EXPECT_EQ(points[0].time_s, -1.0);
  // x is that of the front; the angle is clockwise from north: 90 degrees is east.
  EXPECT_LT(glm::distance(points[0].position_m, dvec3(110.0 - 0.5 * 4.28, 20.0, 0.5)), 1e-12);
  EXPECT_LT(glm::distance(points[0].orientation.value() * dvec3(1, 0, 0), dvec3(1, 0, 0)), 1e-12);
  EXPECT_EQ(tracks[0].stretches[1].points.size(), 1u);
}

TEST(RecordedTraffic, RefusesWhatIsWrong) {
  const auto message = [](const std::string& text) {
    try {
      parse_fcd(text, "run.xml", {});
      return std::string("accepted");
    } catch (const UserError& error) {
      return std::string(error.what());
    }
  };
  EXPECT_THAT(message("<fcd-export>"), HasSubstr("run.xml:1: XML: "));
  EXPECT_THAT(message("<routes/>"), HasSubstr("expected the root element <fcd-export>"));
  EXPECT_THAT(message("<fcd-export/>"), HasSubstr("expected one <vehicle> or <person> or more, found none"));
  EXPECT_THAT(
      message("<fcd-export>\n<timestep time=\"0\">\n<vehicle id=\"a\" x=\"1\" angle=\"0\"/>\n</timestep>\n"
              "</fcd-export>"),
      HasSubstr("run.xml:3: <vehicle>: y: expected a number"));
  EXPECT_THAT(message("<fcd-export><timestep time=\"1\"/>\n<timestep time=\"1\"/></fcd-export>"),
              HasSubstr("run.xml:2: <timestep>: time: expected a time after 1, found 1"));
}

TEST(RecordedTraffic, ReadsOpenScenarioTrajectories) {
  const char* const text =
      R"(<OpenSCENARIO><Storyboard><Trajectory name="ego" closed="false"><Shape><Polyline>
<Vertex time="0"><Position><WorldPosition x="0" y="0" z="0" h="0"/></Position></Vertex>
<Vertex time="2"><Position><WorldPosition x="10" y="0" z="0" h="1.5707963267948966"/></Position></Vertex>
</Polyline></Shape></Trajectory></Storyboard></OpenSCENARIO>)";
  const auto tracks = parse_xosc(text, "run.xosc", {});
  ASSERT_EQ(tracks.size(), 1u);
  EXPECT_EQ(tracks[0].id, "ego");
  const std::vector<WayPoint>& points = tracks[0].stretches[0].points;
  EXPECT_LT(glm::distance(points[1].position_m, dvec3(10.0, 1.4, 0.0)), 1e-12);
  EXPECT_THROW(parse_xosc("<OpenSCENARIO/>", "run.xosc", {}), UserError);
}

/// A track is where its file says, and far below while it is absent.
TEST(RecordedTraffic, AppearsAndVanishes) {
  const test::TemporaryFolder folder;
  std::ofstream(folder.path() / "run.xml") << fcd;
  const Scenario scenario = parse_scenario(
      "greatx: 1\nname: test\nticks: 50\ntick_rate_hz: 10\ntraffic: {fcd: run.xml, types: {my_bus: coach}}\n"
      "nodes: [{name: cam, trajectory: {type: follow, node: vehicle_a, position_m: [1, 0, 2]}}]\n",
      "test.yaml", folder.path(), "");
  ASSERT_EQ(scenario.nodes.size(), 4u);
  EXPECT_EQ(scenario.nodes[3].name, "vehicle_b_1");
  EXPECT_EQ(std::get<Generated>(scenario.nodes[3].model->source).variant, "coach");
  const NodeCourses made = make_node_courses(scenario, 0);
  const Course &cam = *made.courses[0], &a = *made.courses[1];
  const Motion driving = a.at(1.5);
  EXPECT_LT(glm::distance(driving.pose.position, dvec3(25.0 - 2.14, 20.0, 0.0)), 1e-9);
  EXPECT_LT(glm::distance(driving.velocity, dvec3(10.0, 0.0, 0.0)), 1e-9);
  EXPECT_NEAR(a.travel(1.5).distance_m, 15.0, 1e-9);
  EXPECT_LT(glm::distance(cam.at(1.5).pose.position, driving.pose.position + dvec3(1, 0, 2)), 1e-9);
  for (const double absent_s : {-0.1, 2.1, 3.5, 4.1}) {
    EXPECT_LT(a.at(absent_s).pose.position.z, -4999.0) << absent_s;
    EXPECT_EQ(a.at(absent_s).velocity, dvec3(0.0));
    EXPECT_EQ(a.travel(absent_s).speed_mps, 0.0);
  }
  EXPECT_NEAR(a.travel(3.5).distance_m, 20.0, 1e-9);
}

// ------------------------------------------------------------------------------------------------- the world

struct Street {
  explicit Street(const std::string& yaml)
      : scenario(parse_scenario(yaml, "test.yaml", ".", "")),
        world(load_world(scenario)),
        courses(make_courses(scenario, world, 0)) {}
  /// The turn about +y of a shank of a cyclist at rest, from hanging: knee and pedal by circles that meet.
  static double lean_at_rest(const scene::BicycleShape& shape, double side) {
    const dvec2 pedal(shape.bracket_m.x - shape.hip_m.x + side * shape.crank_m * std::cos(shape.rest),
                      shape.bracket_m.z - shape.hip_m.z - side * shape.crank_m * std::sin(shape.rest));
    const double below = shape.shank_m + shape.pedal_m, lower = std::hypot(below, shape.ball_m),
                 far = glm::length(pedal);
    const double along = (shape.thigh_m * shape.thigh_m - lower * lower + far * far) / (2.0 * far);
    const dvec2 ahead(-pedal.y, pedal.x);  // across the line from the hip, forward
    const dvec2 knee =
        (along * pedal + std::sqrt(shape.thigh_m * shape.thigh_m - along * along) * ahead) / far;
    const dvec2 down = pedal - knee;
    return std::atan2(-down.x, -down.y) + std::atan2(shape.ball_m, below);
  }
  Scenario scenario;
  World world;
  Courses courses;
};

TEST(TrafficWorld, NeedsStreets) {
  const Scenario room = parse_scenario(
      "greatx: 1\nname: t\nticks: 1\nscene: {generate: {kind: room}}\ntraffic: {pedestrians: 1}\n", "t.yaml",
      ".", "");
  try {
    load_world(room);
    FAIL();
  } catch (const UserError& error) {
    EXPECT_THAT(error.what(), HasSubstr("t.yaml:5: traffic: expected a scene with streets"));
  }
}

/// Bodies of wheels and limbs move as their poses say: velocities are derivatives, also of a shank, which
/// hangs on a thigh.
TEST(TrafficWorld, PartsHaveExactDerivatives) {
  const Street street(city("{vehicles: 2, cyclists: 1, pedestrians: 3, warm_up_s: 5}"));
  const scene::Scene& scene = street.world.scene;
  int limbs = 0, wheels = 0;
  const double h = 1e-5;
  for (uint32_t body = 1; body < scene.bodies.size(); ++body) {
    const std::string& name = scene.bodies[body].name;
    limbs += name.find("/shank") != std::string::npos ? 1 : 0;
    wheels += name.find("/wheel") != std::string::npos ? 1 : 0;
    for (double t = 0.031; t < 8.0; t += 0.2) {
      const Motion now = body_motion(street.world, street.courses, body, t),
                   before = body_motion(street.world, street.courses, body, t - h),
                   after = body_motion(street.world, street.courses, body, t + h);
      EXPECT_LT(glm::length(now.velocity - (after.pose.position - before.pose.position) / (2 * h)), 1e-4)
          << name;
      const dquat turn = after.pose.orientation * glm::conjugate(before.pose.orientation);
      const dvec3 rate = dvec3(turn.x, turn.y, turn.z) * (turn.w < 0.0 ? -1.0 : 1.0) / h;
      EXPECT_LT(glm::length(now.angular_velocity - rate), 2e-3) << name << " at " << t;
    }
  }
  EXPECT_EQ(limbs, 8);
  EXPECT_GE(wheels, 6);
  const uint32_t shank = scene.body_index("pedestrian_000/shank_left");
  EXPECT_EQ(scene.bodies[scene.bodies[shank].joint->owner].name, "pedestrian_000/thigh_left");
  EXPECT_EQ(scene.bodies[scene.owner_of(shank)].name, "pedestrian_000");
}

/// Wheels roll: the point of a rear wheel that touches the ground stands still on it.
TEST(TrafficWorld, WheelsRoll) {
  const Street street(city("{vehicles: 2, warm_up_s: 5, mix: {saloon: 1}}"));
  const scene::VehicleShape& shape = scene::vehicle_shape("saloon");
  const uint32_t vehicle = street.world.scene.body_index("vehicle_000");
  int moving = 0;
  for (double t = 0.0; t < 80.0; t += 0.31) {
    // In the middle between both rear wheels.
    const Motion body = body_motion(street.world, street.courses, vehicle, t);
    const Motion left = body_motion(street.world, street.courses,
                                    street.world.scene.body_index("vehicle_000/" + shape.wheels[2].node), t);
    const dvec3 axle =
        body.velocity + glm::cross(body.angular_velocity, body.pose.rotate({shape.rear_axle_x_m, 0.0, 0.0}));
    const double spin = glm::dot(left.angular_velocity, body.pose.rotate({0.0, 1.0, 0.0}));
    EXPECT_NEAR(spin * shape.wheels[2].radius_m, glm::dot(axle, body.pose.rotate({1.0, 0.0, 0.0})), 1e-9);
    moving += glm::length(axle) > 1.0 ? 1 : 0;
  }
  EXPECT_GT(moving, 20);
}

/// The axle below the ball of a cyclist's foot is where the crank has it, and goes with it.
TEST(TrafficWorld, FeetStayOnThePedals) {
  const Street street(city("{cyclists: 3, warm_up_s: 5}"));
  const scene::Scene& scene = street.world.scene;
  int turning = 0;
  for (int i = 0; i < 3; ++i) {
    const std::string name = fmt::format("cyclist_{:03}", i);
    const std::string& variant = street.scenario.traffic->members[size_t(i)].variant;
    const scene::BicycleShape shape = scene::bicycle_shape(variant).value();
    for (double t = 0.0; t < 40.0; t += 0.173) {
      const auto motion = [&](const std::string& part) {
        return body_motion(street.world, street.courses, scene.body_index(name + part), t);
      };
      const Motion crank = motion("/crank"), body = motion("");
      const dvec3 left = body.pose.rotate({0.0, 1.0, 0.0});
      for (const double side : {1.0, -1.0}) {
        const Motion shank = motion(side > 0.0 ? "/shank_left" : "/shank_right");
        const dvec3 arm = side * shape.crank_m * dvec3(std::cos(shape.rest), 0.0, -std::sin(shape.rest));
        const dvec3 of_crank = crank.pose.rotate(arm);
        // The part's frame has the bicycle's axes at rest, when the shank already leans.
        const double lean = street.lean_at_rest(shape, side);
        const dvec3 of_shank = shank.pose.rotate(glm::angleAxis(lean, dvec3(0.0, 1.0, 0.0)) *
                                                 dvec3(shape.ball_m, 0.0, -shape.shank_m - shape.pedal_m));
        dvec3 apart = crank.pose.position + of_crank - shank.pose.position - of_shank;
        apart -= glm::dot(apart, left) * left;
        EXPECT_LT(glm::length(apart), 2e-6) << name << " at " << t;  // the file rounds to a millionth
        dvec3 drift = crank.velocity + glm::cross(crank.angular_velocity, of_crank) - shank.velocity -
                      glm::cross(shank.angular_velocity, of_shank);
        drift -= glm::dot(drift, left) * left;
        EXPECT_LT(glm::length(drift), 1e-4 + 0.2 * glm::length(body.angular_velocity)) << name;
      }
      const double rate = glm::dot(crank.angular_velocity, left);
      EXPECT_GE(rate, -1e-9);
      turning += rate > 1.0 ? 1 : 0;
    }
  }
  EXPECT_GT(turning, 100);
}

/// The soles of those who walk stand on the ground: the lower end of one shank hardly moves.
TEST(TrafficWorld, FeetStandOnTheGround) {
  const Street street(city("{pedestrians: 4, warm_up_s: 20, mix: {man: 1}}"));
  const scene::PersonShape& shape = scene::person_shape("man");
  for (int person = 0; person < 4; ++person) {
    const std::string name = fmt::format("pedestrian_{:03}", person);
    for (double t = 0.0; t < 10.0; t += 0.037) {
      double least = 1e9, lowest = 1e9;
      double speed = 0.0;
      const Motion root = body_motion(street.world, street.courses, street.world.scene.body_index(name), t);
      for (const char* side : {"left", "right"}) {
        const Motion shank = body_motion(street.world, street.courses,
                                         street.world.scene.body_index(name + "/shank_" + side), t);
        const dvec3 down = shank.pose.rotate({0.0, 0.0, -shape.shank_m});
        const dvec3 sole = shank.velocity + glm::cross(shank.angular_velocity, down);
        least = std::min(least, glm::length(dvec2(sole)));  // kerbs are slopes
        lowest = std::min(lowest, shank.pose.position.z + down.z);
        speed = glm::length(dvec2(root.velocity));
      }
      if (speed < Gait::full_speed_mps) continue;
      // In a bend a foot turns about the middle of the body, from which it is up to 0.45 m away.
      EXPECT_LT(least, 0.01 + 0.45 * glm::length(root.angular_velocity)) << name << " at " << t;
      const double ground = root.pose.position.z;
      EXPECT_LT(lowest, ground + 0.2);
    }
  }
}

/// Two loads give the same poses to the bit, and another sequence gives others.
TEST(TrafficWorld, IsTheSameAgain) {
  const std::string yaml = city("{vehicles: 2, pedestrians: 2, warm_up_s: 5}");
  const Street first(yaml), again(yaml);
  const Courses other = make_courses(first.scenario, first.world, 1);
  EXPECT_EQ(first.world.scene.hash, again.world.scene.hash);
  const std::vector<Pose> a = body_poses(first.world, first.courses, 7.3),
                          b = body_poses(again.world, again.courses, 7.3),
                          c = body_poses(first.world, other, 7.3);
  ASSERT_EQ(a.size(), b.size());
  for (size_t i = 0; i < a.size(); ++i) {
    EXPECT_EQ(a[i].position, b[i].position);
    EXPECT_EQ(a[i].orientation, b[i].orientation);
    if (i > 0) {
      EXPECT_NE(a[i].position, c[i].position);
    }
  }
}

}  // namespace
}  // namespace greatx::sim
