// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// The table of knobs on the embedded scenarios, and measurements of a few of them on a device.
#include "sim/tradeoff/knob.h"

#include <algorithm>
#include <limits>
#include <map>
#include <set>

#include <gtest/gtest.h>

#include "assets/assets.h"
#include "sim/scenario/parse/load_scenario.h"
#include "sim/tradeoff/measure.h"
#include "tests/support/gpu_fixture.h"

namespace greatx::sim {
namespace {

Scenario embedded(std::string_view name) {
  const auto found = std::ranges::find(embedded_scenarios(), name, &EmbeddedScenario::name);
  return parse_scenario(std::string(found->text), std::string(name) + ".yaml", ".");
}

Experiment alone_of(const Experiment& whole, Modality modality) {
  return make_experiment(alone(whole.scenario, modality, {}).value(), whole);
}

std::vector<Experiment> experiments_of(const Experiment& experiment, const Knob& knob) {
  std::vector<Experiment> settings;
  for (const Setting& setting : knob.settings) {
    std::vector<YamlChange> changes = knob.context_changes;
    changes.insert(changes.end(), setting.changes.begin(), setting.changes.end());
    settings.push_back(make_experiment(changed(experiment.scenario, changes, {}), experiment));
  }
  return settings;
}

TEST(Knobs, AloneLeavesTheSensorsOfOneModality) {
  const Scenario city = embedded("city");
  const auto kinds = [&](Modality modality) {
    std::multiset<size_t> found;
    const Scenario scenario = alone(city, modality, {}).value();
    for (const NodeConfig& node : scenario.nodes)
      for (const SensorConfig& sensor : node.sensors) found.insert(sensor.config.index());
    return found;
  };
  EXPECT_EQ(kinds(Modality::camera), (std::multiset<size_t>{0, 4, 4}));
  EXPECT_EQ(kinds(Modality::events), (std::multiset<size_t>{1, 4, 4}));
  EXPECT_EQ(kinds(Modality::lidar), (std::multiset<size_t>{2, 4, 4}));
  EXPECT_EQ(kinds(Modality::radar), (std::multiset<size_t>{3, 4, 4}));
  EXPECT_EQ(kinds(Modality::csi), (std::multiset<size_t>{4, 4}));
  EXPECT_EQ(alone(city, Modality::csi, {})->channels.size(), 1u);
  EXPECT_TRUE(alone(city, Modality::radar, {})->channels.empty());
  EXPECT_FALSE(alone(embedded("canyon"), Modality::radar, {}).has_value());
}

TEST(Knobs, AloneKeepsTheCameraWhosePixelsAnEventCameraHas) {
  std::string text(std::ranges::find(embedded_scenarios(), "city", &EmbeddedScenario::name)->text);
  const size_t begin = text.find("{name: events, "), end = text.find("}}", begin) + 2;
  ASSERT_NE(begin, text.npos);
  text.replace(begin, end - begin, "{name: events, type: event_camera, rate_hz: 10, camera: front}");
  const Scenario scenario = alone(parse_scenario(text, "city.yaml", "."), Modality::events, {}).value();
  std::multiset<size_t> kinds;
  for (const NodeConfig& node : scenario.nodes)
    for (const SensorConfig& sensor : node.sensors) kinds.insert(sensor.config.index());
  EXPECT_EQ(kinds, (std::multiset<size_t>{0, 1, 4, 4}));
}

TEST(Knobs, EverySettingOfEveryScenarioParses) {
  for (const char* const name : {"city", "room", "canyon", "city_events", "city_fog", "city_night"}) {
    const Experiment whole = make_experiment(embedded(name));
    for (const Modality modality : all_modalities) {
      if (!alone(whole.scenario, modality, {})) continue;
      const Experiment experiment = alone_of(whole, modality);
      for (const bool quick : {false, true})
        for (const Knob& knob : knobs_of(experiment, modality, quick)) {
          SCOPED_TRACE(std::string(name) + " " + std::string(name_of(modality)) + " " + knob.name);
          EXPECT_FALSE(knob.about.empty());
          ASSERT_LT(knob.reference, knob.settings.size());
          EXPECT_LT(knob.standard.value_or(0), knob.settings.size());
          if (knob.skipped.empty()) {
            EXPECT_NO_THROW(experiments_of(experiment, knob));
          }
        }
    }
  }
}

TEST(Knobs, NamedModalities) {
  for (const Modality modality : all_modalities) EXPECT_EQ(modality_of(name_of(modality)), modality);
  EXPECT_FALSE(modality_of("sonar").has_value());
}

const Knob& knob_of(const std::vector<Knob>& knobs, const std::string& name) {
  return *std::ranges::find(knobs, name, &Knob::name);
}
double error_of(const SettingResult& result, const std::string& name) {
  for (const SensorError& error : result.errors)
    if (error.figure.name == name) return error.figure.value;
  ADD_FAILURE() << "no figure " << name;
  return 0.0;
}

TEST(Knobs, WhatActsOnAFewLinksHasAuto) {
  const Experiment whole = make_experiment(embedded("city")), experiment = alone_of(whole, Modality::csi);
  const std::vector<Knob> knobs = knobs_of(experiment, Modality::csi, false);
  const Knob& knob = knob_of(knobs, "every_element");
  EXPECT_TRUE(is_effect(knob));
  ASSERT_EQ(knob.settings.size(), 3u);
  EXPECT_EQ(knob.settings[1].label, "auto");
  EXPECT_EQ(knob.standard, 1u);
  EXPECT_EQ(knob.reference, 2u);
  EXPECT_EQ(knob_of(knobs, "reflection").settings.size(), 2u);
}

TEST(Measure, EndsEarlyWithTwoTimedTicksOfEachSetting) {
  const Experiment whole = make_experiment(embedded("room")), experiment = alone_of(whole, Modality::csi);
  const std::vector<Knob> knobs = knobs_of(experiment, Modality::csi, true);
  const Knob& depth = knob_of(knobs, "max_depth");
  MeasurePlan plan = plan_blocks(whole.scenario, 2, 4);
  plan.most_ms = 0.0;
  for (const SettingResult& result : measure_settings(test::device(), experiments_of(experiment, depth),
                                                      depth.reference, "csi", plan, [](double) {})) {
    EXPECT_EQ(result.wall_ms.size(), 2u);
    EXPECT_EQ(result.start_ms.size(), 1u);
    EXPECT_FALSE(result.errors.empty());
  }
}

TEST(Measure, DeeperPathsAreNearerToTheDeepest) {
  const Experiment whole = make_experiment(embedded("room")), experiment = alone_of(whole, Modality::csi);
  const std::vector<Knob> knobs = knobs_of(experiment, Modality::csi, true);
  const Knob& depth = knob_of(knobs, "max_depth");
  const std::vector<Experiment> settings = experiments_of(experiment, depth);
  const std::vector<SettingResult> results = measure_settings(
      test::device(), settings, depth.reference, "csi", plan_blocks(whole.scenario, 2, 2), [](double) {});
  ASSERT_EQ(results.size(), depth.settings.size());
  EXPECT_TRUE(results[depth.reference].exact);
  EXPECT_EQ(error_of(results[depth.reference], "nmse"), -std::numeric_limits<double>::infinity());
  double paths = 100.0;
  for (size_t i = 0; i < results.size(); ++i) {
    EXPECT_EQ(results[i].wall_ms.size(), 4u);
    EXPECT_EQ(results[i].start_ms.size(), 2u);
    EXPECT_LE(error_of(results[i], "paths"), paths);  // a deeper search has the paths of a shallower one
    paths = error_of(results[i], "paths");
  }
  EXPECT_FALSE(results[0].exact);
}

TEST(Measure, TheSameSettingTwiceIsExact) {
  const Experiment whole = make_experiment(embedded("room"));
  for (const Modality modality : all_modalities) {
    if (!alone(whole.scenario, modality, {})) continue;
    const Experiment experiment = alone_of(whole, modality);
    const std::vector<SettingResult> results =
        measure_settings(test::device(), {experiment, experiment}, 0, kind_of(modality),
                         plan_blocks(whole.scenario, 1, 2), [](double) {});
    EXPECT_TRUE(results[1].exact) << name_of(modality);
    for (const SensorError& error : results[1].errors)
      EXPECT_LE(error.figure.value, 0.0) << error.figure.name;
  }
}

TEST(Measure, ProgressGrowsAndMayStop) {
  const Experiment whole = make_experiment(embedded("room")), experiment = alone_of(whole, Modality::csi);
  double last = 0.0;
  const auto grows = [&](double share) {
    EXPECT_GE(share, last);
    last = share;
  };
  measure_settings(test::device(), {experiment}, 0, "csi", plan_blocks(whole.scenario, 2, 2), grows);
  EXPECT_NEAR(last, 1.0, 1e-9);
  struct Stop {};
  EXPECT_THROW(measure_settings(test::device(), {experiment}, 0, "csi", plan_blocks(whole.scenario, 1, 2),
                                [](double) { throw Stop(); }),
               Stop);
}

TEST(Measure, BlocksFitTheScenario) {
  Scenario scenario = embedded("room");
  for (const int64_t ticks : {1, 2, 3, 5, 10, 100}) {
    scenario.ticks = ticks;
    const MeasurePlan plan = plan_blocks(scenario, 3, 4);
    EXPECT_GE(plan.ticks, 1);
    for (const int64_t start : plan.starts) EXPECT_LE(start + plan.warm_up + plan.ticks, ticks) << ticks;
  }
}

}  // namespace
}  // namespace greatx::sim
