// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "sim/scenario/parse/override.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "sim/scenario/parse/load_scenario.h"
#include "sim/scenario/trajectory.h"

namespace greatx::sim {
namespace {

Scenario parse(const std::string& text) { return parse_scenario(text, "s.yaml", "."); }

const std::string curve =
    "nodes:\n  - {name: a, trajectory: {type: bezier, control_points_m: [[0, 0, 0], [1, 0, 0], [2, 1, 0], "
    "[3, 1, 0]]}}\n";

/// Expects that parsing the scenario's text gives the scenario's values, and that the text states them.
void expect_said(const Scenario& scenario) {
  const Scenario again = parse(scenario.text);
  EXPECT_EQ(again.seed, scenario.seed) << scenario.text;
  EXPECT_EQ(again.ticks, scenario.ticks) << scenario.text;
  EXPECT_EQ(again.sequences, scenario.sequences) << scenario.text;
  EXPECT_EQ(again.trajectory_ticks, scenario.trajectory_ticks) << scenario.text;
  EXPECT_EQ(again.nodes.size(), scenario.nodes.size());
}

Scenario overridden(const std::string& text, const ScenarioOverrides& overrides) {
  Scenario scenario = parse(text);
  override_scenario(scenario, overrides);
  expect_said(scenario);
  return scenario;
}

TEST(Override, NothingOrTheSameLeavesTheTextAlone) {
  const std::string text = "greatx: 1\nname: x\nseed: 4  # four\nduration_s: 0.5\ntick_rate_hz: 10\n" + curve;
  EXPECT_EQ(overridden(text, {}).text, text);
  EXPECT_EQ(overridden(text, {4, 5, 1}).text, text);
}

TEST(Override, ValuesAreReplacedAndInsertedBetweenComments) {
  const Scenario s =
      overridden("# head\ngreatx: 1\nname: x # its name\nticks: 5 # long\n" + curve, {7, 3, 2});
  EXPECT_EQ(
      s.text,
      "# head\ngreatx: 1\nseed: 7\nsequences: 2\ntrajectory_ticks: 5\nname: x # its name\nticks: 3 # long\n" +
          curve);
}

TEST(Override, DurationsGiveWayToTicks) {
  const Scenario s =
      overridden("greatx: 1\nname: x\ntick_rate_hz: 30000/1001\nduration_s: 2.5 # s\n", {{}, 4, {}});
  EXPECT_EQ(s.text, "greatx: 1\nname: x\ntick_rate_hz: 30000/1001\nticks: 4 # s\n");
  EXPECT_FALSE(s.trajectory_ticks.has_value()) << "nothing is drawn";
}

TEST(Override, FlowMapsIndentsCarriageReturnsAndWideLetters) {
  EXPECT_EQ(overridden("{greatx: 1, name: x, ticks: 5}", {3, 2, {}}).text,
            "{greatx: 1, seed: 3, name: x, ticks: 2}");
  overridden("  greatx: 1\n  name: x\n  ticks: 5\n", {3, 2, 9});
  overridden("greatx: 1\r\nname: x\r\nticks: 5\r\n", {3, 2, 9});
  overridden("\xEF\xBB\xBFgreatx: 1\nname: x # \xC3\xA9\xE2\x82\xAC\nticks: 5\n", {3, 2, 9});
  overridden("---\n# \xE2\x82\xAC\ngreatx: 1\nname: x\nticks: 5\n...\n", {3, 2, 9});
}

/// Values with anchors or quotes are not replaced in place. An alias elsewhere keeps the value of its anchor.
TEST(Override, AnchorsAliasesAndQuotes) {
  const std::string scene = "scene: {generate: {kind: canyon, seed: *s, size_m: 60}}\n";
  const Scenario s = overridden("greatx: 1\nname: x\nseed: &s 5\nticks: 4\n" + scene, {8, {}, {}});
  EXPECT_EQ(std::get<Generated>(s.scene.objects[0].model.source).seed, 5u);
  EXPECT_EQ(std::get<Generated>(parse(s.text).scene.objects[0].model.source).seed, 5u) << s.text;
  overridden("greatx: 1\nname: x\nduration_s: \"30/7\"\ntick_rate_hz: 7\n", {8, 3, 2});
  overridden("? greatx\n: 1\n? name\n: x\n? ticks\n: 4\n", {8, 3, 2});
}

TEST(Override, CurvesKeepTheirCourse) {
  const std::string text = "greatx: 1\nname: x\nticks: 11\ntick_rate_hz: 10\n" + curve;
  const Scenario whole = parse(text), shorter = overridden(text, {{}, 3, {}}),
                 longer = overridden(text, {{}, 21, {}});
  Scenario twice = shorter;
  override_scenario(twice, {{}, 5, {}});
  EXPECT_EQ(twice.trajectory_ticks, 11);
  const auto at = [](const Scenario& s, double time_s) {
    return make_node_courses(s, 0).courses[0]->at(time_s);
  };
  for (const double time_s : {0.0, 0.1, 0.2, 0.7, 1.0}) {
    EXPECT_EQ(at(shorter, time_s).pose.position, at(whole, time_s).pose.position);
    EXPECT_EQ(at(longer, time_s).velocity, at(whole, time_s).velocity);
  }
  // Beyond its end the curve continues straight with B'(1) = 3 (P3 - P2) per second.
  EXPECT_EQ(at(longer, 2.0).pose.position, dvec3(6, 1, 0));
}

}  // namespace
}  // namespace greatx::sim
