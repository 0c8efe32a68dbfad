// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Lamps that switch: signals show the phases of their junctions, stop lamps the braking, and indicators the
// turns.
#include "sim/world/lamps.h"

#include <cmath>
#include <map>
#include <set>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/units.h"
#include "scene/generator/city/city_network.h"
#include "scene/generator/generate.h"
#include "scene/gltf/model.h"
#include "sim/scenario/parse/load_scenario.h"
#include "sim/traffic/streets.h"
#include "sim/world/moment.h"

namespace greatx::sim {
namespace {

using scene::LampRole;
using scene::Light;

std::string lit_city(const std::string& rest) {
  return "greatx: 1\nname: test\nseed: 3\nticks: 100\ntick_rate_hz: 10\n"
         "scene: {generate: {kind: city, size_m: 300, seed: 7}}\n" +
         rest;
}

/// The network that the file of this city has.
scene::StreetNetwork network() {
  const std::vector<std::byte> glb =
      scene::generate_glb({.kind = "city", .seed = 7, .size_m = 300.0, .variant = {}, .quick = true});
  return scene::load_model("city.glb", glb, {}).streets.value();
}

/// Two phases of 10 + 3 + 2 s and 20 + 4 + 1 s.
const scene::StreetJunction two_phases{{{{1}, 10.0, 3.0, 2.0}, {{0}, 20.0, 4.0, 1.0}}};

TEST(Signals, GoRoundInTheirCycle) {
  const auto lights = [&](uint32_t group, auto of) {
    std::string text;
    for (int second = 0; second < 80; ++second)
      text += "gar"[static_cast<int>(of(two_phases, group, second - 40.0 + 0.5))];
    return text;
  };
  const std::string first = std::string(10, 'g') + std::string(3, 'a') + std::string(27, 'r'),
                    second = std::string(15, 'r') + std::string(20, 'g') + "aaaar";
  EXPECT_EQ(lights(1, scene::light_of), first + first);
  EXPECT_EQ(lights(0, scene::light_of), second + second);
  // People cross the streets of group 1 while those of group 0 have green.
  const std::string cross_1 = std::string(15, 'r') + std::string(20, 'g') + std::string(5, 'r'),
                    cross_0 = std::string(10, 'g') + std::string(30, 'r');
  EXPECT_EQ(lights(1, scene::walk_light_of), cross_1 + cross_1);
  EXPECT_EQ(lights(0, scene::walk_light_of), cross_0 + cross_0);
}

/// Every approach to a junction with signals has one head on its right, which faces those who come, and every
/// zebra there has two heads for people.
TEST(Signals, StandAtTheStreetsOfTheirGroup) {
  const Scenario scenario = parse_scenario(lit_city(""), "test.yaml", ".", "");
  const World world = load_world(scenario);
  const scene::StreetNetwork streets = network();
  std::map<std::string, const scene::Instance*> instances;
  for (const scene::Instance& instance : world.scene.instances) instances[instance.name] = &instance;
  const auto place_of = [&](const scene::StreetSignal& head) {
    return dvec2(instances.at(head.node)->bounds.center() + world.scene.origin);
  };
  std::set<std::pair<uint32_t, uint32_t>> approaches;
  size_t heads = 0, walk_heads = 0, lanes = 0;
  for (const scene::StreetSignal& head : streets.signals) {
    ASSERT_FALSE(streets.junctions[head.junction].phases.empty());
    if (head.walk) {
      ++walk_heads;
      const bool near = std::ranges::any_of(streets.crossings, [&](const scene::StreetCrossing& crossing) {
        return crossing.junction == head.junction && crossing.group == head.group &&
               (glm::distance(dvec2(crossing.from), place_of(head)) < 4.5 ||
                glm::distance(dvec2(crossing.to), place_of(head)) < 4.5);
      });
      EXPECT_TRUE(near) << head.node;
      continue;
    }
    ++heads;
    const bool beside = std::ranges::any_of(streets.lanes, [&](const scene::StreetLane& lane) {
      if (lane.turn() || lane.next.empty()) return false;
      const scene::StreetLane& turn = streets.lanes[lane.next[0]];
      if (!turn.turn() || turn.junction != head.junction || turn.group != head.group) return false;
      const dvec2 end(lane.line.back()), forward = glm::normalize(end - dvec2(lane.line.front()));
      const dvec2 to = place_of(head) - end;
      const double ahead = glm::dot(to, forward), left = forward.x * to.y - forward.y * to.x;
      return ahead > -7.0 && ahead < -1.0 && left < -0.5 * lane.width_m && left > -6.0;
    });
    EXPECT_TRUE(beside) << head.node;
  }
  // One head for each side of each street at each such junction.
  for (size_t i = 0; i < streets.lanes.size(); ++i) {
    const scene::StreetLane& lane = streets.lanes[i];
    if (lane.turn() || lane.right || lane.next.empty()) continue;
    const scene::StreetLane& turn = streets.lanes[lane.next[0]];
    lanes += turn.turn() && !streets.junctions[*turn.junction].phases.empty() ? 1 : 0;
  }
  size_t zebras = 0;
  for (const scene::StreetCrossing& crossing : streets.crossings) zebras += crossing.junction ? 1 : 0;
  EXPECT_EQ(heads, lanes);
  EXPECT_EQ(walk_heads, 2 * zebras);
}

/// At every time each head shows the one light that drivers or people of the simulation see.
TEST(Signals, ShowWhatTheTrafficSees) {
  const Scenario scenario =
      parse_scenario(lit_city("traffic: {vehicles: 1, warm_up_s: 1}\n"), "test.yaml", ".", "");
  const World world = load_world(scenario);
  const Courses courses = make_courses(scenario, world, 0);
  const scene::StreetNetwork made = network();
  std::map<std::string, scene::StreetSignal> heads;
  for (const scene::StreetSignal& head : made.signals) heads[head.node] = head;
  const scene::SwitchedLamps lamps = scene::switched_lamps(world.scene);
  std::set<Light> seen;
  for (double time_s = -3.0; time_s < 45.0; time_s += 0.7) {
    const std::vector<float> factors = world.lamps.factors(courses, time_s);
    ASSERT_EQ(factors.size(), lamps.lamps.size());
    std::map<std::string, std::vector<LampRole>> lit;
    for (size_t i = 0; i < factors.size(); ++i) {
      const scene::SwitchedLamp& lamp = lamps.lamps[i];
      if (lamp.role > LampRole::green) continue;
      EXPECT_TRUE(factors[i] == 0.0f || factors[i] == 1.0f);
      if (factors[i] > 0.0f) lit[world.scene.instances[lamp.instance].name].push_back(lamp.role);
    }
    EXPECT_EQ(lit.size(), heads.size());
    for (const auto& [name, roles] : lit) {
      ASSERT_EQ(roles.size(), 1u) << name;
      const scene::StreetSignal& head = heads.at(name);
      if (head.walk) {
        for (uint32_t crossing = 0; crossing < made.crossings.size(); ++crossing)
          if (made.crossings[crossing].junction == head.junction &&
              made.crossings[crossing].group == head.group) {
            EXPECT_EQ(roles[0] == LampRole::green, world.streets->walk_time(crossing, time_s) > 0.0);
          }
        continue;
      }
      for (const DriveWay& way : world.streets->ways()) {
        if (!way.turn() || way.junction != head.junction || way.group != head.group) continue;
        const Light light = world.streets->light(way, time_s);
        seen.insert(light);
        EXPECT_EQ(roles[0], light == Light::green   ? LampRole::green
                            : light == Light::amber ? LampRole::amber
                                                    : LampRole::red);
      }
    }
  }
  EXPECT_EQ(seen.size(), 3u);
}

/// Signals switch without any traffic, too.
TEST(Signals, NeedNoTraffic) {
  const Scenario scenario = parse_scenario(lit_city(""), "test.yaml", ".", "");
  const World world = load_world(scenario);
  const Courses courses = make_courses(scenario, world, 0);
  EXPECT_NE(world.lamps.factors(courses, 1.0), world.lamps.factors(courses, 20.0));
  EXPECT_EQ(world.lamps.factors(courses, 1.0), world.lamps.factors(courses, 1.0));
}

/// Moves along x at 10 m/s until 1 s, slows down by `braking` until 3 s, and goes on.
class Braking : public Course {
 public:
  explicit Braking(double braking, double yaw = 0.0) : braking_(braking), yaw_(yaw) {}
  Motion at(double time_s) const override {
    Motion motion;
    motion.pose.orientation = orientation_from_yaw_pitch_roll(yaw_, 0.0, 0.0);
    const double since = std::clamp(time_s - 1.0, 0.0, 2.0);
    motion.velocity = dvec3(10.0 - braking_ * since, 0.0, 0.0);
    if (time_s >= 1.0 && time_s < 3.0) motion.acceleration.x = -braking_;
    return motion;
  }
  double most_speed() const override { return 10.0; }
  Travel travel(double) const override { return {}; }

 private:
  double braking_, yaw_;
};

/// UN Regulation 13-H: stop lamps light above 1.3 m/s^2, and stay dark below 0.7 m/s^2.
TEST(StopLamps, LightWithTheDeceleration) {
  for (const double braking : {0.7, 1.3, 4.0})
    for (const double yaw : {0.0, pi}) {  // forwards, and backwards
      const Braking course(braking, yaw);
      for (double time_s = 0.0; time_s < 5.0; time_s += 0.01) {
        const bool lit = stop_lamps_lit(course, time_s);
        if (braking > 1.0) {
          const bool inside = time_s > 1.0 + 1e-9 && time_s < 3.0,
                     outside = time_s < 1.0 - 1e-9 || time_s > 3.0 + stop_hold_s + 1e-9;
          EXPECT_TRUE(lit || !inside) << time_s;
          EXPECT_FALSE(lit && outside) << time_s;
        } else {
          EXPECT_FALSE(lit);
        }
      }
    }
  EXPECT_TRUE(stop_lamps_lit(Braking(5.0), 4.0)) << "it stands on its brake";
}

/// UN Regulation 48: 90 +- 30 flashes a minute.
TEST(Indicators, FlashNinetyTimesAMinute) {
  for (const char* name : {"vehicle_000", "vehicle_001", "b"}) {
    int begun = 0, lit = 0;
    constexpr int looks = 6000;
    for (int i = 0; i < looks; ++i) {
      const bool now = indicator_lit(name, 0.01 * i + 0.003);
      begun += now && !indicator_lit(name, 0.01 * (i - 1) + 0.003) ? 1 : 0;
      lit += now ? 1 : 0;
    }
    EXPECT_EQ(begun, 90) << name;
    EXPECT_NEAR(lit, looks / 2, looks / 100);
  }
}

/// A vehicle's lamps show its course: stop lamps shine in full or as tail lamps, and one side flashes in a
/// turn.
TEST(VehicleLamps, FollowTheTraffic) {
  const Scenario scenario = parse_scenario(
      lit_city("traffic: {vehicles: 8, cyclists: 1, warm_up_s: 20, mix: {saloon: 1, bicycle: 1}}\n"),
      "test.yaml", ".", "");
  const World world = load_world(scenario);
  const Courses courses = make_courses(scenario, world, 0);
  const scene::SwitchedLamps lamps = scene::switched_lamps(world.scene);
  int stops = 0, tails = 0, flashes = 0;
  for (double time_s = 0.0; time_s < 60.0; time_s += 0.37) {
    const std::vector<float> factors = world.lamps.factors(courses, time_s);
    for (size_t i = 0; i < factors.size(); ++i) {
      const scene::SwitchedLamp& lamp = lamps.lamps[i];
      const scene::Instance& instance = world.scene.instances[lamp.instance];
      if (lamp.role <= LampRole::green || instance.body == 0) continue;
      const Course& course = *courses.nodes[world.node_of_body[instance.body]];
      const int side = course.indicated_side(time_s);
      if (lamp.role == LampRole::stop) {
        const bool lit = stop_lamps_lit(course, time_s);
        EXPECT_EQ(factors[i], lit ? 1.0f : tail_share);
        (lit ? stops : tails) += 1;
      } else {
        const bool own = side == (lamp.role == LampRole::left ? 1 : -1);
        EXPECT_TRUE(own || factors[i] == 0.0f);
        flashes += factors[i] > 0.0f ? 1 : 0;
      }
    }
  }
  EXPECT_GT(stops, 50);
  EXPECT_GT(tails, 50);
  EXPECT_GT(flashes, 20);
}

}  // namespace
}  // namespace greatx::sim
