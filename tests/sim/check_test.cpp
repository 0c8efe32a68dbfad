// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Trajectories that keep clear of a world, and the checks on the host, against brute force.
#include <algorithm>
#include <cmath>
#include <random>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/error.h"
#include "sim/check/course_check.h"
#include "sim/check/scene_check.h"
#include "sim/world/free_space.h"
#include "sim/world/moment.h"
#include "sim/world/solids.h"
#include "tests/sim/trajectory_support.h"
#include "tests/support/tiny_scene.h"

namespace greatx::sim {
namespace {

using greatx::test::TinyScene;
using ::testing::HasSubstr;
using testing::scenario_of;

/// Four houses about a crossing, on a ground.
TinyScene crossing() {
  TinyScene tiny;
  tiny.object("ground").quad({-60, -60, 0}, {60, -60, 0}, {60, 60, 0}, {-60, 60, 0});
  for (const int x : {0, 1})
    for (const int y : {0, 1})
      tiny.object("house_" + std::to_string(2 * x + y))
          .box({x ? 6.0 : -40.0, y ? 6.0 : -40.0, 0}, {x ? 40.0 : -6.0, y ? 40.0 : -6.0, 20});
  return tiny;
}

World still_world(const TinyScene& tiny, size_t nodes) {
  return World{tiny.build(), std::vector<uint32_t>(nodes, 0), {0}, {}, {World::no_part}};
}

BezierTrajectory street_flight(double clearance_m) {
  BezierTrajectory bezier;
  bezier.min_m = {-50, -50, 2};
  bezier.max_m = {50, 50, 30};
  bezier.offset_m = {10, 10, 5};
  bezier.clearance_m = clearance_m;
  return bezier;
}

double nearest_by_hand(const scene::Scene& scene, const dvec3& point) {
  double nearest = 1e300;
  for (const scene::Facet& facet : scene.facets)
    for (uint32_t t = 0; t < facet.triangle_count && facet.body == 0; ++t) {
      const auto& c = scene.facet_triangles[facet.first_triangle + t].corners;
      // The nearest of many points of the triangle.
      for (int i = 0; i <= 40; ++i)
        for (int k = 0; k <= 40 - i; ++k)
          nearest = std::min(
              nearest, glm::distance(point, c[0] + (c[1] - c[0]) * (i / 40.0) + (c[2] - c[0]) * (k / 40.0)));
    }
  return nearest;
}

bool in_a_house(const dvec3& p) {
  const auto within = [](double v) { return std::abs(v) > 6.0 && std::abs(v) < 40.0; };
  return p.z > 0 && p.z < 20 && within(p.x) && within(p.y);
}

/// Returns the exact distance to the crossing's houses and ground, from outside of them.
double exact_distance(const dvec3& p) {
  double nearest = p.z;
  for (const int x : {0, 1})
    for (const int y : {0, 1}) {
      const dvec3 low(x ? 6.0 : -40.0, y ? 6.0 : -40.0, 0), high(x ? 40.0 : -6.0, y ? 40.0 : -6.0, 20);
      nearest = std::min(nearest, glm::distance(p, glm::clamp(p, low, high)));
    }
  return nearest;
}

TEST(Solids, DistanceIsThatOfManyPointsOfAllTriangles) {
  const World world = still_world(crossing(), 0);
  std::mt19937 random(3);
  std::uniform_real_distribution<double> across(-55, 55), up(0.1, 35);
  for (int i = 0; i < 40; ++i) {
    const dvec3 p(across(random), across(random), up(random));
    const double by_hand = nearest_by_hand(world.scene, p),
                 found = world.solids().surfaces().distance(p, 1e9);
    EXPECT_LE(found, by_hand + 1e-9);
    EXPECT_GE(found, by_hand - 3.0);  // the points of a triangle lie up to 120 m / 40 apart
    if (!in_a_house(p)) {
      EXPECT_NEAR(found, exact_distance(p), 1e-9);
    }
    EXPECT_EQ(world.solids().surfaces().distance(p, 0.01), 0.01);
  }
}

TEST(Clearance, EveryInstantOfADrawnCurveKeepsIt) {
  for (const double clearance : {0.5, 3.0}) {
    Scenario scenario = scenario_of(street_flight(clearance));
    const World world = still_world(crossing(), 1);
    uint32_t draws = 0;
    for (uint32_t sequence = 0; sequence < 60; ++sequence) {
      const Courses courses = make_courses(scenario, world, sequence);
      draws += courses.draws[0];
      double nearest = 1e300;
      for (int i = 0; i <= 5000; ++i) {
        const dvec3 p = courses.nodes[0]->at(10.0 * i / 5000).pose.position;
        ASSERT_FALSE(in_a_house(p)) << sequence;
        nearest = std::min(nearest, exact_distance(p));
      }
      EXPECT_GE(nearest, clearance) << sequence;
    }
    EXPECT_GT(draws, 100u) << "the test is of no use if most curves are clear at once";
  }
}

TEST(Clearance, RefusesNoCurveThatKeepsMoreThanTheSlack) {
  Scenario free = scenario_of(street_flight(0.0));
  const World world = still_world(crossing(), 1);
  const WorldFreeSpace space(free, world);
  int kept = 0;
  for (uint32_t sequence = 0; sequence < 200; ++sequence) {
    const Courses courses = make_courses(free, world, sequence);
    double nearest = 1e300;
    for (int i = 0; i <= 2000; ++i) {
      const dvec3 p = courses.nodes[0]->at(10.0 * i / 2000).pose.position;
      nearest = std::min(nearest, in_a_house(p) ? 0.0 : exact_distance(p));
    }
    if (nearest < 0.2) continue;
    ++kept;
    // Between two of the 2001 looks the curve moves by less than 0.1 m.
    EXPECT_FALSE(space.too_near(0, nearest - 0.1, *courses.nodes[0], {}, 10.0)) << sequence;
    EXPECT_TRUE(space.too_near(0, nearest + 1e-6, *courses.nodes[0], {}, 10.0)) << sequence;
  }
  EXPECT_GT(kept, 5);
}

TEST(Clearance, WithoutOneNothingChanges) {
  const World world = still_world(crossing(), 1);
  const Scenario scenario = scenario_of(street_flight(0.0));
  for (uint32_t sequence = 0; sequence < 5; ++sequence) {
    const Courses courses = make_courses(scenario, world, sequence);
    const NodeCourses alone = make_node_courses(scenario, sequence);
    EXPECT_EQ(courses.nodes[0]->at(3.0).pose.position, alone.courses[0]->at(3.0).pose.position);
    EXPECT_EQ(courses.draws[0], 1u);
  }
}

TEST(Clearance, NodesKeepItFromEachOther) {
  Scenario scenario = scenario_of(street_flight(0.0));
  const auto add = [&](const char* name, const Trajectory& trajectory) {
    NodeConfig node = scenario.nodes[0];
    node.name = name;
    node.trajectory = trajectory;
    scenario.nodes.push_back(node);
  };
  add("b", street_flight(4.0));
  CorridorTrajectory corridor;
  corridor.center_line_m = {{-50, 0, 10}, {50, 0, 10}};
  corridor.width_m = 8, corridor.height_m = 8;
  add("c", corridor);
  WayPointTrajectory fixed;
  fixed.points = {{0.0, {-50, 0, 10}, {}}, {10.0, {50, 0, 10}, {}}};
  add("d", fixed);
  const World world = still_world(crossing(), 4);
  for (uint32_t sequence = 0; sequence < 40; ++sequence) {
    const Courses courses = make_courses(scenario, world, sequence);
    EXPECT_EQ(courses.draws[3], 0u);
    for (int i = 0; i <= 2000; ++i) {
      const double t = 10.0 * i / 2000;
      const dvec3 b = courses.nodes[1]->at(t).pose.position;
      for (const size_t other : {0u, 2u, 3u})
        ASSERT_GE(glm::distance(b, courses.nodes[other]->at(t).pose.position), 4.0)
            << "node " << other << ", sequence " << sequence << ", " << t << " s";
    }
  }
}

TEST(Clearance, OfNoFreeCurveIsAnErrorThatCounts) {
  const Scenario scenario = scenario_of(street_flight(200.0));
  const World world = still_world(crossing(), 1);
  try {
    make_courses(scenario, world, 2);
    FAIL() << "expected an error";
  } catch (const UserError& error) {
    EXPECT_THAT(error.what(),
                HasSubstr("s.yaml:7: node 'a': clearance_m: expected a trajectory in its box "
                          "[-50, -50, 2] .. [50, 50, 30] m that keeps 200 m in sequence 2, "
                          "found none in 10000 draws: 10000 come too near to the static world"));
  }
}

TEST(SceneCheck, FindsAWorldOnItsSide) {
  EXPECT_TRUE(check_scene(crossing().build()).empty());
  scene::Scene scene = crossing().build();
  scene.bounds = {};
  for (scene::FacetTriangle& triangle : scene.facet_triangles)
    for (dvec3& c : triangle.corners) {
      c = {c.x, -c.z, c.y};  // the y axis was up
      scene.bounds.add(c);
    }
  const std::vector<Finding> findings = check_scene(scene);
  ASSERT_EQ(findings.size(), 1u);
  EXPECT_EQ(findings[0].kind, "on_its_side");
  EXPECT_THAT(findings[0].text, HasSubstr("face -y"));
  EXPECT_TRUE(check_scene(scene::Scene()).empty());
}

/// Makes the experiment of a node that flies straight from `from` to `to` within 10 s, with a camera.
Experiment flight(const dvec3& from, const dvec3& to, const dvec3& look = {}) {
  WayPointTrajectory way;
  way.points = {{0.0, from, {}}, {10.0, to, {}}};
  way.smooth = false;
  Scenario scenario = scenario_of(way);
  scenario.ticks = 101;
  scenario.tick_rate_hz = {10, 1};
  CameraConfig camera;
  camera.fx = camera.fy = 320, camera.cx = 320, camera.cy = 240;
  scenario.nodes[0].sensors.push_back({"cam", {{0, 0, 0}, look}, camera, {10, 1}, {}});
  return make_experiment(std::move(scenario), std::make_shared<const World>(still_world(crossing(), 1)));
}

const Finding* find(const std::vector<Finding>& findings, const std::string& kind) {
  const auto found = std::ranges::find(findings, kind, &Finding::kind);
  return found == findings.end() ? nullptr : &*found;
}

TEST(CourseCheck, CountsTheTicksInsideAndTheWallsPassed) {
  CourseFigures figures;
  uint32_t done = 0;
  // From x = -50 to 50 at 10 m/s along y = 20: 34 m through each of two houses.
  const std::vector<Finding> findings =
      check_courses(flight({-50.25, 20, 10}, {49.75, 20, 10}), figures, [&](uint32_t n) { done = n; });
  EXPECT_EQ(done, 1u);
  const Finding* inside = find(findings, "inside_solid");
  ASSERT_NE(inside, nullptr);
  EXPECT_EQ(inside->subject, "a/cam");
  EXPECT_EQ(inside->severity, Severity::fault);
  EXPECT_THAT(inside->text, HasSubstr("inside 'house_1' at 68 of 101 ticks, first at tick 11 of sequence 0"));
  const Finding* passes = find(findings, "passes_through");
  ASSERT_NE(passes, nullptr);
  EXPECT_THAT(passes->text, HasSubstr("'house_1' at 4 of 101 ticks, first at tick 11"));
  ASSERT_EQ(figures.nodes.size(), 1u);
  EXPECT_NEAR(figures.nodes[0].most_speed, 10.0, 1e-9);
  EXPECT_EQ(figures.ticks, 101u);
}

TEST(CourseCheck, FindsNothingAboveTheRoofs) {
  CourseFigures figures;
  EXPECT_TRUE(
      check_courses(flight({-50, 20, 25}, {40, 20, 25}, {0, 0.8, 0}), figures, [](uint32_t) {}).empty());
  EXPECT_NEAR(figures.nodes.at(0).least_clearance, 5.0, 1e-9);
}

TEST(CourseCheck, FindsWhoPassesAHouseWithinOneTick) {
  CourseFigures figures;
  const std::vector<Finding> findings =
      check_courses(flight({-5000, 20, 10}, {5000, 20, 10}), figures, [](uint32_t) {});
  EXPECT_EQ(find(findings, "inside_solid"), nullptr);
  ASSERT_NE(find(findings, "passes_through"), nullptr);
  EXPECT_THAT(find(findings, "passes_through")->text, HasSubstr("at 2 of 101 ticks"));
  ASSERT_NE(find(findings, "speed"), nullptr);
  EXPECT_EQ(find(findings, "speed")->severity, Severity::doubt);
}

TEST(CourseCheck, CamerasOfSkyAloneAreFaultsAndOfGroundAloneDoubts) {
  CourseFigures figures;
  const double down = std::acos(-1.0) / 2.0;
  const auto sky = check_courses(flight({-50, 0, 25}, {50, 0, 25}, {0, -down, 0}), figures, [](uint32_t) {});
  ASSERT_NE(find(sky, "only_sky"), nullptr);
  EXPECT_EQ(find(sky, "only_sky")->severity, Severity::fault);
  EXPECT_EQ(figures.views.at(0).sky, 1.0);
  const auto ground = check_courses(flight({-50, 0, 4}, {50, 0, 4}, {0, down, 0}), figures, [](uint32_t) {});
  ASSERT_NE(find(ground, "only_ground"), nullptr);
  EXPECT_EQ(find(ground, "only_ground")->severity, Severity::doubt);
  EXPECT_EQ(find(check_courses(flight({-50, 0, 4}, {50, 0, 4}), figures, [](uint32_t) {}), "only_sky"),
            nullptr);
}

TEST(CourseCheck, EmptyWorldsAndManySequencesAreFine) {
  CourseFigures figures;
  Scenario scenario = scenario_of(street_flight(0.0));
  scenario.trajectory_ticks = scenario.ticks;
  scenario.ticks = 3;
  scenario.sequences = 50;
  uint32_t done = 0;
  const Experiment experiment =
      make_experiment(std::move(scenario), std::make_shared<const World>(still_world(TinyScene(), 1)));
  EXPECT_TRUE(check_courses(experiment, figures, [&](uint32_t n) { done = n; }).empty());
  EXPECT_EQ(done, 50u);
  EXPECT_EQ(figures.ticks, 150u);
}

}  // namespace
}  // namespace greatx::sim
