// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// The traffic of the generated city: nobody runs into anybody, signals hold, the same seed gives the same
// traffic.
#include <cmath>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/units.h"
#include "scene/generator/city/city_network.h"
#include "scene/generator/objects/shapes.h"
#include "sim/traffic/course.h"
#include "sim/traffic/pieces.h"
#include "sim/traffic/simulation.h"

namespace greatx::sim {
namespace {

using testing::HasSubstr;
using Kind = TrafficMember::Kind;

const LargestVehicles largest(Extent{4.5, 1.7, 2.25}, Extent{9.1, 3.4, 2.75});

std::shared_ptr<const Streets> city_streets(double size_m = 300.0, uint64_t seed = 7) {
  const auto plan = scene::generator::plan_city(size_m, seed);
  return std::make_shared<const Streets>(scene::generator::city_network(plan), largest, "city.glb");
}

TrafficBody body_of(Kind kind, const std::string& variant) {
  if (kind == Kind::pedestrian) return {kind, {0.45, 0.45, 0.55}, 0.0};
  const scene::VehicleShape& shape = scene::vehicle_shape(variant);
  const double half = 0.5 * shape.length_m;
  return {kind,
          {half - shape.rear_axle_x_m, half + shape.rear_axle_x_m,
           shape.width_m + (shape.two_wheeler ? 0.0 : 0.2)},
          -shape.rear_axle_x_m};
}

std::vector<TrafficBody> bodies(int vehicles, int cyclists, int pedestrians) {
  const std::vector<std::string> kinds{"saloon", "mini",     "panel_van", "suv",       "motorcycle", "pickup",
                                       "taxi",   "city_bus", "lorry",     "box_truck", "minibus"};
  std::vector<TrafficBody> list;
  for (int i = 0; i < vehicles; ++i) list.push_back(body_of(Kind::vehicle, kinds[size_t(i) % kinds.size()]));
  for (int i = 0; i < cyclists; ++i)
    list.push_back(body_of(Kind::cyclist, i % 3 == 0 ? "cargo_bicycle" : "bicycle"));
  for (int i = 0; i < pedestrians; ++i) list.push_back(body_of(Kind::pedestrian, ""));
  return list;
}

TrafficConfig config_of(uint64_t seed) {
  TrafficConfig config;
  config.seed = seed;
  config.where = {"test.yaml", 7};
  return config;
}

GroundBox box_of(Simulation& simulation, uint32_t member, double time_s) {
  const WayState state = simulation.at(member, time_s);
  const WayPlace place = place_on(state.piece, state.way_m);
  const Extent& extent = simulation.body(member).extent;
  const dvec2 forward(std::cos(place.heading), std::sin(place.heading));
  return {dvec2(place.position) + 0.5 * (extent.front_m - extent.rear_m) * forward, forward,
          0.5 * (extent.front_m + extent.rear_m), 0.5 * extent.width_m};
}

/// Returns the number of overlaps of two members' boxes in the first `end_s` seconds, ten looks a second.
int collisions(Simulation& simulation, double end_s) {
  int found = 0;
  std::vector<GroundBox> boxes(simulation.member_count());
  for (int step = 0; step < static_cast<int>(end_s * 10.0); ++step) {
    for (uint32_t i = 0; i < boxes.size(); ++i) boxes[i] = box_of(simulation, i, 0.1 * step);
    for (size_t i = 0; i < boxes.size(); ++i)
      for (size_t j = i + 1; j < boxes.size(); ++j) found += overlap(boxes[i], boxes[j]) ? 1 : 0;
  }
  return found;
}

TEST(Traffic, HasNoCollisions) {
  const auto streets = city_streets();
  for (const uint64_t seed : {1, 2, 3}) {
    Simulation simulation(streets, bodies(20, 6, 30), config_of(seed), 0);
    EXPECT_EQ(collisions(simulation, 1000.0), 0) << "seed " << seed;
    const Simulation::Counts counts = simulation.counts();
    EXPECT_EQ(counts.on_red, 0u);
    EXPECT_GT(counts.turns, 500u);
    EXPECT_GT(counts.crossings, 30u);
    EXPECT_GT(counts.lane_changes, 5u);
  }
}

TEST(Traffic, HasNoCollisionsWhenDense) {
  Simulation simulation(city_streets(), bodies(50, 10, 150), config_of(5), 0);
  EXPECT_EQ(collisions(simulation, 300.0), 0);
  EXPECT_EQ(simulation.counts().on_red, 0u);
  EXPECT_GT(simulation.counts().turns, 200u);  // it does not jam for good
}

TEST(Traffic, HasNoCollisionsInOtherCities) {
  for (const uint64_t seed : {1, 2, 12}) {
    Simulation simulation(city_streets(450.0, seed), bodies(40, 10, 60), config_of(seed), 0);
    EXPECT_EQ(collisions(simulation, 200.0), 0) << seed;
    EXPECT_EQ(simulation.counts().on_red, 0u);
  }
}

/// On a circle the closed form holds; on a straight way the body stays within its own width.
TEST(Traffic, BodiesReachBesideTheirWays) {
  for (const double radius : {8.0, 20.0, 60.0}) {
    std::vector<dvec3> circle;
    for (int i = 0; i <= 400; ++i) {
      const double angle = 1.5 * pi * i / 400.0;
      circle.emplace_back(radius * std::sin(angle), radius * (1.0 - std::cos(angle)), 0.0);
    }
    const Extent bus{9.0, 3.0, 2.75};
    const double expected = std::hypot(radius + 0.5 * bus.width_m, bus.front_m) - radius;
    const Curve curve(circle, dvec2(1.0, 0.0), dvec2(0.0, -1.0));
    EXPECT_NEAR(reach_beside(curve, bus), expected, 0.05 / radius) << radius;
  }
  EXPECT_NEAR(reach_beside(Curve({{0, 0, 0}, {50, 20, 0}}), {9.0, 3.0, 2.75}), 1.375, 1e-9);
}

/// Buses and lorries are simulated on every lane that they take; their bodies stay within it, but for what
/// docs/traffic.md states.
TEST(Traffic, LongerVehiclesStayInTheirLanes) {
  const auto streets = city_streets();
  size_t ways = 0;
  for (const DriveWay& way : streets->ways()) {
    EXPECT_TRUE(way.endless || !way.endless_longer);
    if (!way.endless_longer) continue;
    ++ways;
    EXPECT_FALSE(way.right.has_value());
    if (!way.swings) {
      EXPECT_LE(reach_beside(way.curve, *largest.longer), 0.5 * way.width_m + (way.turn() ? 0.35 : 0.1));
    }
    for (const uint32_t next : way.next_longer) EXPECT_TRUE(streets->ways()[next].endless_longer);
  }
  EXPECT_GE(ways, 20u);
  Simulation simulation(streets, bodies(22, 0, 0), config_of(6), 0);
  for (const uint32_t member : {7u, 8u, 9u, 10u, 18u, 19u, 20u, 21u})
    for (double time_s = 0.0; time_s < 300.0; time_s += 1.0) {
      const Piece piece = simulation.at(member, time_s).piece;
      const auto on = std::ranges::find_if(streets->ways(),
                                           [&](const DriveWay& way) { return &way.curve == piece.curve; });
      ASSERT_NE(on, streets->ways().end());
      EXPECT_TRUE(on->endless_longer);
    }
}

bool inside(const std::vector<dvec2>& outline, const dvec2& point) {
  bool odd = false;
  for (size_t i = 0; i < outline.size(); ++i) {
    const dvec2 &a = outline[i], &b = outline[(i + 1) % outline.size()];
    if ((a.y > point.y) != (b.y > point.y) && point.x < a.x + (point.y - a.y) / (b.y - a.y) * (b.x - a.x))
      odd = !odd;
  }
  return odd;
}

/// Buses and lorries also turn where they swing over other lanes: their bodies stay on the carriageway, as
/// the city's plan has it, and nobody waits where they pass.
TEST(Traffic, LongerVehiclesSwingOverTheCarriagewayAlone) {
  for (const uint64_t seed : {7, 1, 2}) {
    const auto plan = scene::generator::plan_city(300.0, seed);
    std::vector<std::vector<dvec2>> carriageway = plan.junctions;
    for (const auto& street : plan.streets)
      carriageway.push_back({street.left[0], street.right[0], street.right[1], street.left[1]});
    const auto streets = city_streets(300.0, seed);
    int turns = 0;
    for (const DriveWay& turn : streets->ways()) {
      if (!turn.swings || !turn.endless_longer) continue;
      ++turns;
      EXPECT_NE(turn.side, 0);
      EXPECT_GT(reach_beside(turn.curve, *largest.longer), 0.5 * turn.width_m + 0.35);
      for (double s = 0.0; s <= turn.curve.length() + 3.0; s += 0.2) {
        const GroundBox box = box_at(turn.curve, s, *largest.longer);
        const dvec2 left(-box.forward.y, box.forward.x);
        for (const double along : {-1.0, 1.0})
          for (const double side : {-1.0, 1.0}) {
            const dvec2 corner =
                box.middle + along * box.half_length * box.forward + side * box.half_width * left;
            EXPECT_TRUE(
                std::ranges::any_of(carriageway, [&](const auto& part) { return inside(part, corner); }))
                << corner.x << " " << corner.y << " at " << s;
          }
        for (const DriveWay& lane : streets->ways()) {
          if (lane.turn() || lane.next.empty() || !streets->ways()[lane.next[0]].turn()) continue;
          const auto leads = [&](const DriveWay& other) {
            return other.turn() && other.junction == turn.junction && &streets->ways()[other.from] == &lane &&
                   other.from != turn.from;
          };
          if (!std::ranges::any_of(streets->ways(), leads)) continue;
          const double stop_m = lane.gates.back().stop_m;
          EXPECT_FALSE(overlap(box, box_at(lane.curve, stop_m - largest.ordinary.front_m, largest.ordinary)));
        }
      }
    }
    RecordProperty("turns_of_city_" + std::to_string(seed), turns);
    EXPECT_GT(turns, 3) << seed;
  }
}

/// They do take them.
TEST(Traffic, BusesTurnAtJunctions) {
  const auto streets = city_streets();
  Simulation simulation(streets, bodies(22, 0, 0), config_of(6), 0);
  int turns = 0;
  for (const uint32_t member : {7u, 8u, 9u, 18u, 19u, 20u}) {
    const Curve* before = nullptr;
    for (double time_s = 0.0; time_s < 600.0; time_s += 0.5) {
      const Curve* now = simulation.at(member, time_s).piece.curve;
      if (now == before) continue;
      before = now;
      for (const DriveWay& way : streets->ways()) turns += &way.curve == now && way.swings ? 1 : 0;
    }
  }
  RecordProperty("turns", turns);
  EXPECT_GT(turns, 10);
}

/// The mean speed of twenty vehicles is that of level of service D or better: 40 % of the free flow
/// (Highway Capacity Manual 2010, exhibit 16-4), here of the lanes' limits, weighted by where they are.
TEST(Traffic, FlowsAsStreetsWithSignalsDo) {
  const auto streets = city_streets();
  double speeds = 0.0, limits = 0.0;
  for (const uint64_t seed : {1, 2, 3}) {
    Simulation simulation(streets, bodies(20, 0, 30), config_of(seed), 0);
    for (double time_s = 0.0; time_s < 600.0; time_s += 1.0)
      for (uint32_t i = 0; i < 20; ++i) {
        const WayState state = simulation.at(i, time_s);
        const dvec3 place = place_on(state.piece, state.way_m).position;
        if (std::max(std::abs(place.x), std::abs(place.y)) > 150.0) continue;  // in a loop beyond the edge
        speeds += state.speed_mps;
        for (const DriveWay& way : streets->ways())
          if (&way.curve == state.piece.curve) limits += way.turn() ? 30.0 / 3.6 : way.speed_mps;
      }
  }
  RecordProperty("share_of_free_flow", std::to_string(speeds / limits));
  EXPECT_GT(speeds / limits, 0.4);
  EXPECT_LT(speeds / limits, 0.85);  // signals hold some of them
}

/// Whoever leaves at the model's edge comes back: all places are continuous, and no street stays empty.
TEST(Traffic, UsesStreetsThatEndAtTheEdge) {
  const auto streets = city_streets();
  for (const DriveWay& way : streets->ways())
    if (!way.turn() && !way.right) {
      EXPECT_TRUE(way.endless);
    }
  Simulation simulation(streets, bodies(11, 2, 0), config_of(8), 0);
  double furthest = 0.0;
  for (uint32_t i = 0; i < 13; ++i) {
    dvec2 before = box_of(simulation, i, 0.0).middle;
    for (int step = 1; step < 6000; ++step) {
      const dvec2 now = box_of(simulation, i, 0.1 * step).middle;
      EXPECT_LT(glm::distance(now, before), 0.1 * 1.2 * simulation.most_speed_mps(i));
      furthest = std::max({furthest, std::abs(now.x), std::abs(now.y)});
      before = now;
    }
  }
  EXPECT_GT(furthest, 150.0);
  EXPECT_LT(furthest, 190.0);
}

TEST(Traffic, SaysWhichVehiclesAreTooLong) {
  try {
    Simulation simulation(std::make_shared<const Streets>(
                              scene::generator::city_network(scene::generator::plan_city(300.0, 7)),
                              LargestVehicles(Extent{4.5, 1.7, 2.25}, Extent{15.0, 5.0, 2.75}), "city.glb"),
                          {{Kind::vehicle, {15.0, 5.0, 2.75}, 5.0}}, config_of(1), 0);
    FAIL();
  } catch (const UserError& error) {
    EXPECT_THAT(error.what(),
                HasSubstr("found one of 20.0 m, for which the streets of city.glb have no way"));
  }
}

/// Nobody stands for minutes: every wait ends.
TEST(Traffic, GoesOn) {
  Simulation simulation(city_streets(), bodies(20, 6, 30), config_of(4), 0);
  std::vector<double> before(simulation.member_count(), 0.0);
  for (double time_s = 0.0; time_s <= 1000.0; time_s += 200.0)
    for (uint32_t i = 0; i < simulation.member_count(); ++i) {
      const double way_m = simulation.at(i, time_s).way_m;
      if (time_s > 0.0) {
        EXPECT_GT(way_m, before[i] + 20.0) << i << " at " << time_s;
      }
      before[i] = way_m;
    }
}

/// The same seed and sequence give the same places, in whatever order times are asked.
TEST(Traffic, IsDrawnFromItsSeed) {
  const auto streets = city_streets();
  Simulation first(streets, bodies(10, 3, 10), config_of(1), 0),
      again(streets, bodies(10, 3, 10), config_of(1), 0);
  again.at(0, 333.3);
  again.at(3, 5.0);
  Simulation sequence(streets, bodies(10, 3, 10), config_of(1), 1),
      seed(streets, bodies(10, 3, 10), config_of(2), 0);
  int differ = 0;
  for (uint32_t i = 0; i < 23; ++i)
    for (const double time_s : {-100.0, -3.0, 0.0, 17.23, 120.0}) {
      const GroundBox a = box_of(first, i, time_s), b = box_of(again, i, time_s);
      EXPECT_EQ(a.middle, b.middle);
      EXPECT_EQ(a.forward, b.forward);
      differ += a.middle != box_of(sequence, i, time_s).middle ? 1 : 0;
      differ += a.middle != box_of(seed, i, time_s).middle ? 1 : 0;
    }
  EXPECT_EQ(differ, 2 * 23 * 5);
}

/// Positions, headings and distances have the derivatives that they say, also across steps and pieces.
TEST(Traffic, CoursesHaveExactDerivatives) {
  const auto simulation = std::make_shared<Simulation>(city_streets(), bodies(12, 6, 12), config_of(3), 0);
  const double h = 1e-4;
  double fastest = 0.0, sideways = 0.0;
  for (uint32_t i = 0; i < simulation->member_count(); ++i) {
    const auto course = make_traffic_course(simulation, i);
    const double axle_m = simulation->body(i).origin_m;
    for (double t = 0.0503; t < 150.0; t += 0.7) {  // within a step, whose acceleration is constant
      const Motion now = course->at(t), before = course->at(t - h), after = course->at(t + h);
      const auto near = [&](const dvec3& a, const dvec3& b, double most) {
        EXPECT_LT(glm::length(a - b), most) << "member " << i << " at " << t;
      };
      near(now.velocity, (after.pose.position - before.pose.position) / (2 * h), 2e-5);
      near(now.acceleration, (after.velocity - before.velocity) / (2 * h), 0.03);
      const dquat turn = after.pose.orientation * glm::conjugate(before.pose.orientation);
      near(now.angular_velocity, dvec3(turn.x, turn.y, turn.z) / h, 2e-4);
      const Travel travel = course->travel(t);
      EXPECT_NEAR(travel.speed_mps,
                  (course->travel(t + h).distance_m - course->travel(t - h).distance_m) / (2 * h), 1e-5);
      EXPECT_LE(glm::length(now.velocity), course->most_speed());
      fastest = std::max(fastest, travel.speed_mps);
      // The rear axle moves forward only.
      const dvec3 axle = now.velocity - glm::cross(now.angular_velocity, now.pose.rotate({axle_m, 0, 0}));
      sideways = std::max(sideways, std::abs(glm::dot(axle, now.pose.rotate({0, 1, 0}))));
      EXPECT_GE(glm::dot(axle, now.pose.rotate({1, 0, 0})), -1e-9);
    }
  }
  EXPECT_GT(fastest, 8.0);
  EXPECT_LT(sideways, 1e-9);
}

TEST(Traffic, StartsAtTimeZeroOfItsDistance) {
  const auto simulation = std::make_shared<Simulation>(city_streets(), bodies(5, 1, 5), config_of(3), 0);
  for (uint32_t i = 0; i < 11; ++i)
    EXPECT_EQ(make_traffic_course(simulation, i)->travel(0.0).distance_m, 0.0);
}

TEST(Traffic, SaysWhenThereIsNoRoom) {
  try {
    Simulation simulation(city_streets(150.0), bodies(500, 0, 0), config_of(1), 0);
    FAIL();
  } catch (const UserError& error) {
    EXPECT_THAT(error.what(),
                HasSubstr("test.yaml:7: traffic: expected at most as many vehicles and cyclists "
                          "as the streets of city.glb have room for, about "));
  }
}

/// The phases of a junction never give green to two of its groups, and everyone has red in between.
TEST(Traffic, SignalsExcludeEachOther) {
  const auto streets = city_streets();
  int greens = 0, reds = 0;
  for (double time_s = -50.0; time_s < 100.0; time_s += 0.25)
    for (const DriveWay& a : streets->ways())
      for (const DriveWay& b : streets->ways()) {
        if (!a.turn() || !b.turn() || a.junction != b.junction || a.group == b.group) continue;
        const Light first = streets->light(a, time_s), second = streets->light(b, time_s);
        if (first == Light::green && second == Light::green) {
          // Only where there are no signals at all.
          EXPECT_EQ(streets->light(a, time_s + 11.0), Light::green);
          EXPECT_EQ(streets->light(a, time_s + 29.0), Light::green);
          continue;
        }
        greens += first == Light::green ? 1 : 0;
        reds += first == Light::red && second == Light::red ? 1 : 0;
        EXPECT_TRUE(first == Light::red || second == Light::red);
      }
  EXPECT_GT(greens, 1000);
  EXPECT_GT(reds, 100);
}

/// Whoever turns shows it from 30 m before on, on the side to which the way bends, and nobody who does not.
TEST(Traffic, IndicatesTurnsAndChangesOfLane) {
  Simulation simulation(city_streets(), bodies(14, 0, 0), config_of(5), 0);
  int turning = 0, before = 0, straight = 0, changing = 0;
  for (uint32_t member = 0; member < simulation.member_count(); ++member)
    for (double time_s = 0.0; time_s < 120.0; time_s += 0.5) {
      const WayState state = simulation.at(member, time_s);
      const Piece& piece = state.piece;
      const int side = indicated_side(state);
      if (piece.change_m != 0.0 && state.way_m < piece.begin_m + piece.change_length_m) {
        EXPECT_EQ(side, piece.change_m > 0.0 ? -1 : 1);
        // It moves to that side.
        const WayPlace now = place_on(piece, state.way_m), later = place_on(piece, state.way_m + 0.1);
        const dvec2 along = piece.curve->at(piece.at_m + state.way_m - piece.begin_m).tangent;
        const dvec2 step = dvec2(later.position) - dvec2(now.position);
        EXPECT_GE(double(side) * (along.x * step.y - along.y * step.x), -1e-6);
        ++changing;
        continue;
      }
      const double length = piece.curve->length(),
                   to_end = length - piece.at_m - (state.way_m - piece.begin_m);
      const bool on_turn = piece.turn_m == piece.begin_m && length < 40.0;
      if (on_turn && piece.turn_side != 0) {
        const dvec2 a = piece.curve->at(0.0).tangent, b = piece.curve->at(length).tangent;
        EXPECT_EQ(side, a.x * b.y - a.y * b.x > 0.0 ? 1 : -1) << member << " at " << time_s;
        ++turning;
      } else if (!on_turn && to_end > 31.0) {
        EXPECT_EQ(side, 0);
        ++straight;
      } else if (!on_turn && to_end < 29.0 && piece.turn_side != 0) {
        EXPECT_EQ(side, piece.turn_side);
        ++before;
      }
    }
  EXPECT_GT(turning, 20);
  EXPECT_GT(before, 20);
  EXPECT_GT(straight, 100);
  EXPECT_GT(changing, 0);
}

/// The way that is pedalled is the integral of share times speed, and a cyclist coasts while he brakes.
TEST(Traffic, CyclistsCoastWhenTheyBrake) {
  const Effort effort{0.75, 0.5};
  double sum = 0.0;
  constexpr int parts = 1000;
  for (int i = 0; i < parts; ++i) {  // exact for each part up to its curvature
    const double t = 0.1 * (i + 0.5) / parts;
    sum += (0.75 - 2.5 * t) * (4.0 - 1.5 * t) * 0.1 / parts;
  }
  const EffortWay all = effort_way(effort, 4.0, -1.5, 0.1, 0.1);
  EXPECT_NEAR(all.way_m, sum, 1e-9);
  EXPECT_NEAR(all.speed_mps, 0.5 * 3.85, 1e-12);
  EXPECT_NEAR(all.acceleration_mps2, -1.5 * 0.5 - 2.5 * 3.85, 1e-12);

  Simulation simulation(city_streets(), bodies(0, 6, 0), config_of(2), 0);
  int coasting = 0, pedalling = 0;
  for (uint32_t member = 0; member < simulation.member_count(); ++member) {
    double braked_s = 0.0, went_s = 0.0, before_m = -1e9;
    for (int step = 0; step < 1500; ++step) {
      const WayState state = simulation.at(member, 0.1 * step + 0.05);
      EXPECT_GE(state.pedalled_m, before_m);
      before_m = state.pedalled_m;
      EXPECT_GE(state.pedalled_mps, -1e-12);
      EXPECT_LE(state.pedalled_mps, state.speed_mps + 1e-12);
      const bool brakes =
          state.acceleration_mps2<-1.1 * coasting_mps2, goes = state.acceleration_mps2> - 0.9 * coasting_mps2;
      braked_s = brakes ? braked_s + 0.1 : 0.0;
      went_s = goes ? went_s + 0.1 : 0.0;
      if (braked_s > effort_s + 0.15) {
        EXPECT_NEAR(state.pedalled_mps, 0.0, 1e-12);
        ++coasting;
      }
      if (went_s > effort_s + 0.15) {
        EXPECT_NEAR(state.pedalled_mps, state.speed_mps, 1e-12);
        ++pedalling;
      }
    }
  }
  EXPECT_GT(coasting, 50);
  EXPECT_GT(pedalling, 500);
}

}  // namespace
}  // namespace greatx::sim
