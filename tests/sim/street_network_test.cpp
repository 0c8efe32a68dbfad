// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Streets in a glTF file: written, read, refused.
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/units.h"
#include "scene/generator/city/city_network.h"
#include "scene/network/network.h"
#include "sim/traffic/streets.h"

namespace greatx {
namespace {

using scene::StreetNetwork;
using testing::HasSubstr;

std::string document(const std::string& streets) {
  return fmt::format(R"({{"scenes": [{{"extras": {{"greatx_streets": {}}}}}]}})", streets);
}

StreetNetwork read(const std::string& streets) {
  return scene::street_network_of_document(document(streets), {"street.gltf", 0}).value();
}

std::string message_of(const std::string& streets) {
  try {
    read(streets);
    return "accepted";
  } catch (const UserError& error) {
    return error.what();
  }
}

TEST(StreetNetwork, SurvivesItsFile) {
  const StreetNetwork made = scene::generator::city_network(scene::generator::plan_city(300.0, 7));
  const StreetNetwork back = read(scene::street_network_json(made));
  ASSERT_EQ(back.lanes.size(), made.lanes.size());
  for (size_t i = 0; i < made.lanes.size(); ++i) {
    ASSERT_EQ(back.lanes[i].line.size(), made.lanes[i].line.size());
    for (size_t k = 0; k < made.lanes[i].line.size(); ++k)
      EXPECT_LT(glm::distance(back.lanes[i].line[k], made.lanes[i].line[k]), 1e-4);
    EXPECT_EQ(back.lanes[i].next, made.lanes[i].next);
    EXPECT_EQ(back.lanes[i].left, made.lanes[i].left);
    EXPECT_EQ(back.lanes[i].junction, made.lanes[i].junction);
    EXPECT_EQ(back.lanes[i].group, made.lanes[i].group);
  }
  EXPECT_EQ(back.walks.size(), 16u);
  ASSERT_EQ(back.crossings.size(), made.crossings.size());
  EXPECT_EQ(back.crossings[3].junction, made.crossings[3].junction);
  // What is written again is the same text.
  EXPECT_EQ(scene::street_network_json(back), scene::street_network_json(made));
  EXPECT_FALSE(scene::street_network_of_document(R"({"scenes": [{}]})", {"a", 0}));
}

TEST(StreetNetwork, NamesWhatIsWrong) {
  const std::string lane = R"({"line": [[0,0,0],[9,0,0]], "width_m": 3, "speed_mps": 9, "next": [)";
  EXPECT_EQ(message_of(R"({"lanes": [)" + lane + "]}]}"), "accepted");
  EXPECT_THAT(message_of(R"({"lanes": [)" + lane + "1]}]}"),
              HasSubstr("street.gltf: scenes[0].extras.greatx_streets.lanes[0].next[0]: expected"));
  EXPECT_THAT(message_of(R"({"lanes": [)" + lane + "0]}]}"),
              HasSubstr("expected a lane that begins where this one ends (within 0.25 m)"));
  EXPECT_THAT(message_of(R"({"lanes": [{"line": [[0,0,0]], "width_m": 3, "speed_mps": 9, "next": []}]})"),
              HasSubstr("lanes[0].line: expected two points or more"));
  EXPECT_THAT(message_of(R"({"lanes": [{"line": [[0,0,0],[1,0,0]], "speed_mps": 9, "next": []}]})"),
              HasSubstr("width_m"));
  EXPECT_THAT(message_of(R"({"lane": []})"), HasSubstr("lane: expected nothing: there is no such member"));
  EXPECT_THAT(message_of(R"({"crossings": [{"from": [0,0,0], "to": [0.5,0,0], "width_m": 3, "walks": [0,0]}],
                          "walks": [{"line": [[0,0,0],[1,0,0],[0,1,0]]}]})"),
              HasSubstr("crossings[0].to: expected a point 1 m or more from 'from'"));
  EXPECT_THAT(
      message_of(R"({"lanes": [{"junction": 0, "line": [[0,0,0],[1,0,0]], "width_m": 3, "speed_mps": 9,
                          "next": []}], "junctions": [{}]})"),
      HasSubstr(R"(junction: expected "turn": true beside it)"));
}

TEST(StreetNetwork, KeepsItsSignals) {
  StreetNetwork made;
  made.junctions = {{}, {{{{0}, 9.0, 3.0, 2.0}}}};
  made.signals = {{"signal_000", 1, 0, false}, {"walk_signal_000", 1, 2, true}};
  const StreetNetwork back = read(scene::street_network_json(made));
  ASSERT_EQ(back.signals.size(), 2u);
  EXPECT_EQ(back.signals[0].node, "signal_000");
  EXPECT_FALSE(back.signals[0].walk);
  EXPECT_EQ(back.signals[1].junction, 1u);
  EXPECT_EQ(back.signals[1].group, 2u);
  EXPECT_TRUE(back.signals[1].walk);
  EXPECT_THAT(message_of(R"({"junctions": [{}], "signals": [{"node": "a", "junction": 1, "group": 0}]})"),
              HasSubstr("greatx_streets.signals[0].junction: expected"));
  EXPECT_THAT(message_of(R"({"junctions": [{}], "signals": [{"junction": 0, "group": 0}]})"),
              HasSubstr("signals[0]"));
}

/// Lanes of the city begin where others end, in the same direction.
TEST(StreetNetwork, OfTheCityIsSmooth) {
  for (const uint64_t seed : {1, 7, 23})
    for (const double size_m : {150.0, 300.0, 600.0}) {
      const StreetNetwork network = scene::generator::city_network(scene::generator::plan_city(size_m, seed));
      const sim::Streets streets(network, sim::Extent{4.5, 1.7, 2.25}, "city.glb");
      size_t turns = 0;
      for (const sim::DriveWay& way : streets.ways()) {
        turns += way.turn() ? 1 : 0;
        for (const uint32_t next : way.next) {
          const sim::CurvePlace end = way.curve.at(way.curve.length()),
                                begin = streets.ways()[next].curve.at(0.0);
          EXPECT_LT(glm::distance(end.position, begin.position), 2e-4);
          EXPECT_GT(glm::dot(end.tangent, begin.tangent), 1.0 - 1e-6);
          EXPECT_LT(std::abs(end.curvature - begin.curvature), 0.02);
        }
        EXPECT_LT(way.curve.most_curvature(), 0.25);  // a car's turning circle of 8 m and more
      }
      EXPECT_GE(turns, size_m < 200.0 ? 12u : 100u);
      EXPECT_EQ(streets.paths().size(), 2 * network.crossings.size());
    }
}

/// Two opposite carriageways, whose middle lines are apart, and a curve that is known: a circle.
TEST(StreetCurve, FollowsACircle) {
  constexpr double radius = 10.0;
  std::vector<dvec3> points;
  for (int i = 0; i <= 40; ++i) {
    const double angle = 0.5 * pi * i / 40.0;
    points.emplace_back(radius * std::sin(angle), radius * (1.0 - std::cos(angle)), 0.0);
  }
  const sim::Curve curve(points, dvec2(1.0, 0.0), dvec2(0.0, 1.0));
  EXPECT_NEAR(curve.length(), 0.5 * pi * radius, 1e-5);
  const double h = 1e-4;
  for (double s = 0.01; s < curve.length(); s += 0.31) {
    const sim::CurvePlace place = curve.at(s);
    EXPECT_NEAR(place.position.x, radius * std::sin(s / radius), 1e-5);
    EXPECT_NEAR(place.curvature, 1.0 / radius, 2e-4);
    EXPECT_NEAR(glm::length(place.tangent), 1.0, 1e-14);
    const sim::CurvePlace before = curve.at(s - h), after = curve.at(s + h);
    EXPECT_LT(glm::distance(place.tangent, (after.position - before.position) / (2 * h)), 1e-8);
    EXPECT_NEAR(place.curvature, glm::dot((after.tangent - before.tangent) / (2 * h), place.left()), 1e-6);
  }
}

}  // namespace
}  // namespace greatx
