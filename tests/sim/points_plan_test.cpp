// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Effects that depend on distance must follow every possible end: points given from outside, mounts and
// elements far from their node, and moving reflectors.
#include <cmath>
#include <complex>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "rf/atmosphere/bounds.h"
#include "sim/channel/radio_map.h"
#include "sim/plan/radio_plan.h"
#include "sim/scenario/parse/load_scenario.h"
#include "tests/sim/radio_run.h"

namespace greatx::sim {
namespace {

using sim::testing::experiment_in;
using sim::testing::RadioRun;
using sim::testing::run;
using test::TinyScene;

/// Returns a mast and a terminal beside it in an empty world. The tested ends are farther away.
std::string scenario(double carrier_hz, const std::string& weather,
                     const std::string& position_m = "[0.1, 0, 20]", const std::string& antenna = "") {
  return fmt::format(
      "greatx: 1\nname: test\nticks: 1\nenvironment: {{{}}}\n"
      "nodes:\n"
      "  - name: bs\n    trajectory: {{type: static, position_m: [0, 0, 20]}}\n"
      "    sensors: [{{name: antenna, type: antenna}}]\n"
      "  - name: ue\n    trajectory: {{type: static, position_m: {}}}\n"
      "    sensors: [{{name: antenna, type: antenna{}}}]\n"
      "channels:\n  - {{name: csi, tx: bs/antenna, rx: [ue/antenna], rate_hz: 10, subcarriers: 4, "
      "bandwidth_hz: 20e6, carrier_hz: {}, max_depth: 0}}\n",
      weather, position_m, antenna, carrier_hz);
}

/// Returns the paths to `asked` in a call that has the points `all`.
std::vector<rf::Path> paths_to(const std::string& yaml, const dvec3& asked, const std::vector<dvec3>& all) {
  scene::Bounds points;
  for (const dvec3& point : all) points.add(point);
  const Experiment experiment = experiment_in(yaml, TinyScene().build(), points);
  ChannelSnapshot snapshot(test::device(), experiment, 0, {});
  std::vector<rf::Path> paths;
  snapshot.solve(std::span(&asked, 1), 0, [&](ChannelSnapshot::Link link) {
    paths = std::move(link.paths);
    return true;
  });
  return paths;
}

double decibels_of(const rf::Path& path) { return 20.0 * std::log10(std::abs(path.transfer[0])); }

struct Air {
  double carrier_hz;
  const char* weather;
};

TEST(PointsPlan, APlaceHasTheSamePathsAsANodeAndAsAPoint) {
  const dvec3 far(1000, 0, 20);
  for (const Air& air : {Air{60e9, ""}, Air{28e9, "rain_mm_h: 25"}}) {
    const std::string yaml = scenario(air.carrier_hz, air.weather);
    const std::vector<rf::Path> point = paths_to(yaml, far, {far});
    ASSERT_EQ(point.size(), 1u);
    const RadioRun node = run(scenario(air.carrier_hz, air.weather, "[1000, 0, 20]"), TinyScene().build());
    const auto transfer = node.values<std::complex<float>>(0, "transfer");
    ASSERT_EQ(transfer.size(), 4u);
    for (size_t i = 0; i < 4; ++i)
      EXPECT_EQ(transfer[i], std::complex<float>(point[0].transfer[i])) << air.carrier_hz;
    EXPECT_EQ(node.values<double>(0, "delay")[0], point[0].delay_s);
    // The air does attenuate this path. At a terminal beside the mast the plan leaves its effects out.
    const double without = decibels_of(
        paths_to(scenario(air.carrier_hz, air.weather) + "effects: {gas: off, rain: off}\n", far, {far})[0]);
    const Scenario parsed = parse_scenario(yaml, "test.yaml", ".");
    const rf::Weather weather = weather_of(parsed.environment);
    const double taken_db = without - decibels_of(point[0]);
    EXPECT_GT(taken_db, 3.0) << air.carrier_hz;
    const double most_db =
        rf::most_gas_db(weather, air.carrier_hz, 1000.0) + rf::most_rain_db(weather, air.carrier_hz, 1000.0);
    EXPECT_LE(taken_db, most_db + 1e-9)  // rounding of two logarithms
        << air.carrier_hz;
  }
}

TEST(PointsPlan, AllPointsOfACallDecideTogether) {
  const dvec3 near(0.2, 0, 20), far(1000, 0, 20);
  const std::string yaml = scenario(60e9, "");
  const double alone = decibels_of(paths_to(yaml, near, {near})[0]),
               beside = decibels_of(paths_to(yaml, near, {near, far})[0]);
  EXPECT_LT(beside, alone) << "with gas";
  EXPECT_NEAR(beside, alone, 0.01) << "within the tolerance";
}

EffectPlan plan_of(const std::string& yaml, const scene::Scene& scene = TinyScene().build()) {
  return make_effect_plan(parse_scenario(yaml, "test.yaml", "."), scene);
}

TEST(PointsPlan, MountsAndElementsFarFromTheirNodeCount) {
  EXPECT_FALSE(plan_of(scenario(60e9, "")).gas.on);
  EXPECT_TRUE(plan_of(scenario(60e9, "", "[0.1, 0, 20]", ", mount: {position_m: [0, 900, 0]}")).gas.on);
  // 100,000 wavelengths of 5 mm are 500 m.
  EXPECT_TRUE(plan_of(scenario(60e9, "", "[0.1, 0, 20]", ", elements_wl: [[0, 0, 0], [0, 1e5, 0]]")).gas.on);
}

TEST(PointsPlan, WhatMovesAndReflectsCounts) {
  TinyScene tiny;
  const uint32_t body = tiny.body("ue"), metal = tiny.material_as(sim::testing::radio_material("metal"));
  tiny.object("vane", body, metal).quad({0, 0, 0}, {400, 0, 0}, {400, 0, 5}, {0, 0, 5});
  std::string yaml = scenario(60e9, "");
  yaml.replace(yaml.find("max_depth: 0"), 12, "max_depth: 1, search: every_tick");
  const EffectPlan moving = plan_of(yaml, tiny.build());
  EXPECT_TRUE(moving.moving_reflectors.on);
  EXPECT_TRUE(moving.gas.on) << moving.gas.bound;
  EXPECT_FALSE(plan_of(yaml + "effects: {moving_reflectors: off}\n", tiny.build()).gas.on)
      << "that blocks, and makes no path longer";
}

TEST(PointsPlan, CellsOfAMapCount) {
  const scene::Scene scene = TinyScene().build();
  const MapGrid grid = make_map_grid({0, 0}, {1000, 10}, 10.0, 1);
  const scene::Bounds cells = bounds_of_cells(grid, {20.0, 1.5, MapOver::ground}, scene);
  EXPECT_EQ(cells.min, dvec3(5, 5, 20));
  EXPECT_EQ(cells.max, dvec3(995, 5, 20));
  const Scenario parsed = parse_scenario(scenario(60e9, ""), "test.yaml", ".");
  const EffectPlan plan = make_effect_plan(parsed, scene, cells);
  EXPECT_TRUE(plan.gas.on);
  EXPECT_FALSE(same_effects(plan, make_effect_plan(parsed, scene)));
  EXPECT_TRUE(same_effects(plan, plan));
  // A draped map follows the ground at a constant height above it.
  TinyScene hill;
  hill.object("ground").quad({0, 0, 3}, {10, 0, 3}, {10, 10, 30}, {0, 10, 30});
  const scene::Bounds draped = bounds_of_cells(grid, {std::nullopt, 1.5, MapOver::ground}, hill.build());
  EXPECT_NEAR(draped.min.z, 4.5, 1e-5);
  EXPECT_NEAR(draped.max.z, 31.5, 1e-5);
}

}  // namespace
}  // namespace greatx::sim
