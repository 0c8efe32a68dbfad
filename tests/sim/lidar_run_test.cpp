// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Tests LiDARs in whole runs: targets at the time of each shot, effects of the plan, and random draws.
#include <cmath>
#include <map>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "assets/assets.h"
#include "core/units.h"
#include "sim/scenario/parse/load_scenario.h"
#include "tests/support/kept_run.h"

namespace greatx::sim {
namespace {

using test::keep_run;
using test::KeptRun;

constexpr double speed = 20.0;  ///< speed of the car towards north, m/s

/// Returns a street along y and a LiDAR at rest in it. The car passes in the middle of the LiDAR's sweep.
std::string street(const std::string& lidar, const std::string& more = "") {
  return "greatx: 1\nname: test\nseed: 5\nticks: 2\ntick_rate_hz: 10\n"
         "scene: {generate: {kind: canyon, seed: 9, size_m: 80}, optical_only: true}\n"
         "nodes:\n  - name: mast\n    trajectory: {type: static, position_m: [-2, 0, 2.5], rotation_deg: [0, "
         "0, 0]}\n"
         "    sensors:\n      - {name: lidar, type: lidar, rate_hz: 10, channels: 12, elevation_min_deg: "
         "-40, "
         "elevation_max_deg: 0, azimuth_start_deg: 180, azimuth_steps: 512" +
         lidar +
         "}\n  - name: car\n    trajectory: {type: waypoints, interpolation: linear, points: [{t_s: 0, "
         "position_m: [2.4, "
         "-3, 0]}, {t_s: 1, position_m: [2.4, 17, 0]}]}\n    model: {generate: {kind: car, variant: "
         "hatchback}}\n" +
         more;
}

/// Counts the returns of the car and says how far they lie outside its bounds, after the car's pose at each
/// return's own time is undone.
struct CarReturns {
  size_t count = 0;
  double outside_m = 0.0;
};
CarReturns car_returns(const KeptRun& run, size_t packet) {
  scene::Bounds bounds;
  for (const scene::Instance& instance : run.instances)
    if (instance.body != 0) bounds.add(instance.bounds);
  const auto points = run.array<float>(packet, "mast/lidar", "points"),
             times = run.array<float>(packet, "mast/lidar", "time_offset");
  const auto ids = run.array<uint32_t>(packet, "mast/lidar", "instance");
  CarReturns result;
  for (size_t i = 0; i < ids.size(); ++i) {
    if (run.instances.at(ids[i] - 1).body == 0) continue;
    ++result.count;
    const double t = 0.1 * static_cast<double>(packet) + double{times[i]};
    const dvec3 world(points[4 * i] - 2.0, points[4 * i + 1], points[4 * i + 2] + 2.5);
    const dvec3 body(world.y - (-3.0 + speed * t), 2.4 - world.x, world.z);  // the car looks north
    for (int axis = 0; axis < 3; ++axis)
      result.outside_m =
          std::max({result.outside_m, bounds.min[axis] - body[axis], body[axis] - bounds.max[axis]});
  }
  return result;
}

TEST(LidarRun, ACarThatDrivesIsMetWhereItIsAtEachShot) {
  const KeptRun moving = keep_run(street(", sweep_s: 0.1"));
  EXPECT_TRUE(moving.plan.lidar_target_motion.on);
  const KeptRun frozen = keep_run(street(", sweep_s: 0.1", "effects: {lidar_target_motion: off}\n"));
  for (size_t packet = 0; packet < 2; ++packet) {
    const CarReturns exact = car_returns(moving, packet), stale = car_returns(frozen, packet);
    EXPECT_GT(exact.count, 100u);
    EXPECT_LT(exact.outside_m, 1e-4);
    // The LiDAR sees the car about a twentieth of a second after the tick, its front first. Returns with the
    // pose of the tick lie decimetres off.
    EXPECT_GT(stale.outside_m, 0.3);
    EXPECT_LT(stale.outside_m, 0.1 * speed);
  }
}

TEST(LidarRun, WithoutASweepEverythingIsAtTheTick) {
  const KeptRun at_tick = keep_run(street(""));
  EXPECT_FALSE(at_tick.plan.lidar_target_motion.on);
  EXPECT_FALSE(at_tick.plan.lidar_sweep_motion.on);
  EXPECT_LT(car_returns(at_tick, 1).outside_m, 1e-4);
}

void expect_same(const KeptRun& a, const KeptRun& b) {
  for (const ArraySpec& array : a.spec("mast/lidar").arrays)
    for (size_t packet = 0; packet < 2; ++packet)
      EXPECT_TRUE(a.array(packet, "mast/lidar", array.name).bytes ==
                  b.array(packet, "mast/lidar", array.name).bytes)
          << array.name;
}

const std::string instrument =
    ", beam: {divergence_mrad: 3, rings: 1}, detection: {range_m: 30}, noise: {range_m: 0.02, rise_m: 0.3}";

TEST(LidarRun, WhatIsSwitchedOffChangesNoByte) {
  const std::string fog = "environment: {fog_g_m3: 0.1}\n";
  const KeptRun plain = keep_run(street("", fog + "effects: {lidar_glass: off}\n"));
  const KeptRun off = keep_run(
      street(instrument, fog + "effects: {lidar_glass: off, lidar_divergence: off, lidar_detection: off, "
                               "lidar_range_noise: off, lidar_backscatter: off}\n"));
  expect_same(plain, off);
  EXPECT_TRUE(off.plan.lidar_haze.on);
}

TEST(LidarRun, DrawsAreTheTicksAndTheSensorsAlone) {
  const KeptRun run = keep_run(street(instrument)), again = keep_run(street(instrument));
  EXPECT_TRUE(run.plan.lidar_divergence.on && run.plan.lidar_detection.on && run.plan.lidar_range_noise.on);
  expect_same(run, again);
  // Neither another sensor nor a start at the second tick changes anything.
  const KeptRun beside = keep_run(
      street(instrument + "}\n      - {name: camera, type: camera, rate_hz: 10, width: 8, height: 8, "
                          "fov_deg: 90"));
  expect_same(run, beside);
  // The same shot has two different draws at two ticks: the walls do not move, but their ranges change.
  const auto first = run.array<float>(0, "mast/lidar", "range"),
             second = run.array<float>(1, "mast/lidar", "range");
  const size_t count = std::min(first.size(), second.size());
  EXPECT_GT(count, 500u);
  EXPECT_FALSE(std::equal(first.begin(), first.begin() + 100, second.begin()));
}

/// The return of a surface. surfaces_of() finds it by channel and direction, which do not depend on the air.
struct Shot {
  double range_m = 0.0, intensity = 0.0, power = 0.0;
};
std::map<std::pair<uint16_t, int>, Shot> surfaces_of(const KeptRun& run) {
  const auto points = run.array<float>(0, "uav/lidar", "points"),
             range = run.array<float>(0, "uav/lidar", "range"),
             power = run.array<float>(0, "uav/lidar", "power");
  const auto ring = run.array<uint16_t>(0, "uav/lidar", "ring");
  const auto instance = run.array<uint32_t>(0, "uav/lidar", "instance");
  std::map<std::pair<uint16_t, int>, Shot> shots;
  for (size_t i = 0; i < range.size(); ++i) {
    if (instance[i] == 0) continue;
    const double azimuth = std::atan2(points[4 * i + 1], points[4 * i]);
    shots[{ring[i], static_cast<int>(std::lround(azimuth / (2.0 * pi) * 1024))}] = {
        range[i], points[4 * i + 3], power[i]};
  }
  return shots;
}

/// In the fog of the embedded city the LiDAR loses returns that it has in clear air. The air's extinction on
/// the way there and back weakens the others.
TEST(LidarRun, FogWeakensTheEmbeddedCityInFog) {
  const auto embedded = std::ranges::find(embedded_scenarios(), "city_fog", &EmbeddedScenario::name);
  Scenario fog = parse_scenario(std::string(embedded->text), "city_fog.yaml", ".");
  ASSERT_GT(fog.environment.fog_g_m3, 0.0);
  fog.ticks = 1;
  fog.channels.clear();
  for (NodeConfig& node : fog.nodes)
    std::erase_if(node.sensors, [](const SensorConfig& sensor) {
      return !std::holds_alternative<LidarConfig>(sensor.config);
    });
  Scenario clear = fog;
  clear.environment.fog_g_m3 = 0.0;
  Scenario blind = fog;  // detects every return
  blind.effects["lidar_detection"] = blind.effects["lidar_backscatter"] = Switch::off;
  const auto world = std::make_shared<const World>(load_world(fog));
  const KeptRun in_fog = keep_run(make_experiment(fog, world)),
                in_clear = keep_run(make_experiment(clear, world)),
                all = keep_run(make_experiment(blind, world));
  EXPECT_TRUE(in_fog.plan.lidar_haze.on && in_fog.plan.lidar_detection.on &&
              in_fog.plan.lidar_backscatter.on);
  const auto with = surfaces_of(in_fog), without = surfaces_of(in_clear), whatever = surfaces_of(all);
  const auto count = static_cast<double>(with.size());
  EXPECT_LT(count, 0.8 * static_cast<double>(without.size()));
  EXPECT_GT(count, 0.2 * static_cast<double>(without.size()));
  EXPECT_LT(without.size(), whatever.size());
  // The fog itself answers a few shots.
  const size_t returns = in_fog.array<float>(0, "uav/lidar", "range").size();
  EXPECT_GT(returns, with.size());
  EXPECT_LT(static_cast<double>(returns), 1.2 * count);

  const double extinction = 0.1447 * std::pow(0.05, 0.88);  // Kunkel 1984
  size_t both = 0;
  double farthest_with = 0.0, farthest_without = 0.0;
  for (const auto& [shot, clear_return] : without) {
    farthest_without = std::max(farthest_without, clear_return.range_m);
    const auto found = with.find(shot);
    if (found == with.end()) continue;
    ++both;
    const Shot& foggy = found->second;
    farthest_with = std::max(farthest_with, foggy.range_m);
    EXPECT_EQ(foggy.range_m, clear_return.range_m);
    const double left = std::exp(-2.0 * extinction * foggy.range_m);
    EXPECT_NEAR(foggy.intensity, clear_return.intensity * left, 1e-6);
    EXPECT_NEAR(foggy.power, clear_return.power * left, 1e-6 * clear_return.power);
  }
  EXPECT_GT(static_cast<double>(both), 0.95 * count);  // noise lifts a few others above the threshold
  EXPECT_LT(farthest_with, farthest_without);
}

TEST(LidarRun, ThePlanSaysWhatTheSceneCallsFor) {
  const KeptRun plain = keep_run(street(""));
  EXPECT_TRUE(plain.plan.lidar_glass.on);  // the car has glass
  EXPECT_THAT(plain.plan.lidar_glass.reason, ::testing::HasSubstr("lets light through"));
  for (const Effect* effect :
       {&plain.plan.lidar_divergence, &plain.plan.lidar_detection, &plain.plan.lidar_range_noise,
        &plain.plan.lidar_backscatter, &plain.plan.lidar_haze})
    EXPECT_FALSE(effect->on) << effect->name;
  const KeptRun rain = keep_run(street(", detection: {range_m: 30}", "environment: {rain_mm_h: 20}\n"));
  EXPECT_TRUE(rain.plan.lidar_haze.on && rain.plan.lidar_backscatter.on);
  EXPECT_THAT(rain.plan.lidar_backscatter.bound, ::testing::HasSubstr("reflectance"));
}

}  // namespace
}  // namespace greatx::sim
