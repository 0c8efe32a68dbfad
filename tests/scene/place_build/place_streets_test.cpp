// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Streets from the ways of a place: lanes by tags, turns where ways meet, and traffic that does not collide.
#include <cmath>

#include <gtest/gtest.h>

#include "core/units.h"
#include "scene/place/assemble/street_network.h"
#include "sim/traffic/pieces.h"
#include "sim/traffic/simulation.h"

namespace greatx::scene::place {
namespace {

using sim::Extent;
using Kind = sim::TrafficMember::Kind;

Feature way(const std::string& id, std::vector<dvec2> line,
            std::map<std::string, std::string, std::less<>> tags) {
  Feature feature;
  feature.source = "map";
  feature.id = id;
  feature.lines = {std::move(line)};
  feature.tags = std::move(tags);
  return feature;
}

/// A block of 80 m by 100 m with four ways about it, of which two go on to the border, and a path within.
PlaceInput block() {
  PlaceInput input;
  input.features = {way("way/1", {{-150, 0}, {-40, 0}, {40, 0}, {100, 0}, {150, 0}},
                        {{"highway", "tertiary"}, {"lanes", "2"}}),
                    way("way/2", {{-40, -150}, {-40, 0}, {-40, 100}, {40, 100}, {40, 0}},
                        {{"highway", "residential"}, {"maxspeed", "40"}}),
                    way("way/3", {{0, 40}, {10, 60}, {0, 80}}, {{"highway", "footway"}}),
                    way("way/4", {{40, 0}, {40, -60}}, {{"highway", "service"}, {"service", "driveway"}}),
                    way("way/5", {{100, 0}, {100, -60}}, {{"highway", "residential"}, {"oneway", "yes"}}),
                    way("way/6", {{0, 0}, {0, -30}}, {{"highway", "residential"}, {"bridge", "yes"}})};
  return input;
}

double slope(const dvec2& p) { return 0.05 * p.x; }

StreetNetwork network_of(const PlaceInput& input) {
  std::vector<Finding> findings;
  const GroundPlan ground = ground_plan(input, {}, findings);
  return place_streets(input, ground, {{-170, -170}, {170, 170}}, slope, [](const dvec2&) { return false; });
}

TEST(PlaceStreets, HaveLanesByTags) {
  const StreetNetwork network = network_of(block());
  // Way 1 is split at -40, 40 and 100.
  size_t east = 0, fast = 0;
  for (const StreetLane& lane : network.lanes) {
    for (const dvec3& point : lane.line)
      if (std::max(std::abs(point.x), std::abs(point.y)) < 169.0) {
        EXPECT_NEAR(point.z, slope(dvec2(point)), 1e-9);
      }
    if (lane.turn() || lane.line.size() < 2) continue;
    const dvec2 along = glm::normalize(dvec2(lane.line.back() - lane.line.front()));
    if (along.x > 0.999 && std::abs(lane.line.front().y) < 5.0) {
      ++east;
      EXPECT_NEAR(lane.line.front().y, -1.625, 1e-9) << "right of the middle by half a lane of 3.25 m";
      EXPECT_NEAR(lane.width_m, 3.25, 1e-9);
      EXPECT_NEAR(lane.speed_mps, 50.0 / 3.6, 1e-9);
    }
    fast += std::abs(lane.speed_mps - 40.0 / 3.6) < 1e-9 ? 1 : 0;
  }
  EXPECT_EQ(east, 4u);
  EXPECT_GE(fast, 4u);
  for (const StreetLane& lane : network.lanes)
    for (const dvec3& point : lane.line) {
      EXPECT_FALSE(std::abs(point.x - 40.0) < 3.0 && point.y < -20.0) << "a driveway";
      EXPECT_FALSE(std::abs(point.x) < 3.0 && point.y < -10.0) << "a bridge";
      EXPECT_FALSE(std::abs(point.x - 100.0) < 0.5 && point.y < -20.0 && lane.line.back().y > lane.line[0].y)
          << "against a one-way street";
    }
}

/// The file's own checks hold: lanes begin where the ones before them end.
TEST(PlaceStreets, AreReadAgain) {
  const StreetNetwork network = network_of(block());
  const std::string json =
      R"({"scenes":[{"extras":{"greatx_streets":)" + street_network_json(network) + "}}]}";
  const auto again = street_network_of_document(json, {"place.glb", 0});
  ASSERT_TRUE(again.has_value());
  EXPECT_EQ(again->lanes.size(), network.lanes.size());
  EXPECT_EQ(again->walks.size(), network.walks.size());
  EXPECT_GE(again->junctions.size(), 3u);
}

/// People have room beside all carriageways, and away from each other's lines.
TEST(PlaceStreets, KeepPeopleOffTheCarriageways) {
  const StreetNetwork network = network_of(block());
  EXPECT_GE(network.walks.size(), 8u);
  for (const StreetWalk& walk : network.walks) {
    double area = 0.0;
    for (size_t i = 0; i < walk.line.size(); ++i) {
      const dvec3 &a = walk.line[i], &b = walk.line[(i + 1) % walk.line.size()];
      area += 0.5 * (a.x * b.y - a.y * b.x);
      EXPECT_GT(std::abs(a.y), 3.25 + 0.6) << "off way 1, but for half the band and the side of people";
    }
    EXPECT_GT(area, 0.0) << "counter-clockwise: the carriageway is on the right";
  }
}

TEST(PlaceStreets, CarryTrafficWithoutCollisions) {
  const auto streets = std::make_shared<const sim::Streets>(
      network_of(block()), sim::LargestVehicles(Extent{4.3, 1.5, 2.2}), "place.glb");
  std::vector<sim::TrafficBody> bodies;
  for (int i = 0; i < 10; ++i) bodies.push_back({Kind::vehicle, {3.7, 1.0, 2.0}, 1.3});
  for (int i = 0; i < 3; ++i) bodies.push_back({Kind::cyclist, {1.4, 0.4, 0.6}, 0.5});
  for (int i = 0; i < 16; ++i) bodies.push_back({Kind::pedestrian, {0.45, 0.45, 0.55}, 0.0});
  for (const uint64_t seed : {1, 2, 3}) {
    sim::TrafficConfig config;
    config.seed = seed;
    sim::Simulation simulation(streets, bodies, config, 0);
    std::vector<sim::GroundBox> boxes(bodies.size());
    int found = 0;
    for (int step = 0; step < 3000; ++step) {
      for (uint32_t i = 0; i < boxes.size(); ++i) {
        const sim::WayState state = simulation.at(i, 0.1 * step);
        const sim::WayPlace place = sim::place_on(state.piece, state.way_m);
        const Extent& extent = bodies[i].extent;
        const dvec2 forward(std::cos(place.heading), std::sin(place.heading));
        boxes[i] = {dvec2(place.position) + 0.5 * (extent.front_m - extent.rear_m) * forward, forward,
                    0.5 * (extent.front_m + extent.rear_m), 0.5 * extent.width_m};
      }
      for (size_t i = 0; i < boxes.size(); ++i)
        for (size_t j = i + 1; j < boxes.size(); ++j) found += sim::overlap(boxes[i], boxes[j]) ? 1 : 0;
    }
    EXPECT_EQ(found, 0) << seed;
    EXPECT_GT(simulation.counts().turns, 100u) << seed;
    for (uint32_t i = 0; i < bodies.size(); ++i)
      EXPECT_GT(simulation.at(i, 300.0).way_m, simulation.at(i, 0.0).way_m + 60.0) << i;
  }
}

TEST(PlaceStreets, OfAPlaceWithoutWaysAreEmpty) {
  PlaceInput input = block();
  for (Feature& feature : input.features) feature.tags = {{"waterway", "stream"}};
  EXPECT_TRUE(network_of(input).lanes.empty());
  EXPECT_TRUE(network_of(input).walks.empty());
}

}  // namespace
}  // namespace greatx::scene::place
