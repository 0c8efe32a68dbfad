// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Settings chosen for scenarios that give errors or a time budget. The promise is checked by whole runs of
// the choice and of the reference, with sums of their own, on scenes that nothing was tuned on.
#include "sim/tradeoff/calibration/calibration.h"

#include <algorithm>
#include <cmath>
#include <complex>
#include <set>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "assets/assets.h"
#include "core/error.h"
#include "sim/run/simulator.h"
#include "sim/scenario/parse/load_scenario.h"
#include "sim/tradeoff/calibration/ticks.h"
#include "sim/tradeoff/calibration/wishes.h"
#include "tests/support/gpu_fixture.h"

namespace greatx::sim {
namespace {

Scenario embedded(std::string_view name) {
  const auto found = std::ranges::find(embedded_scenarios(), name, &EmbeddedScenario::name);
  return parse_scenario(std::string(found->text), std::string(name) + ".yaml", ".");
}

Scenario parsed(const std::string& text) { return parse_scenario(text, "test.yaml", "."); }

void ignore(const std::string&) {}

/// A street of its own for every seed: a mast and a receiver that drives through it.
std::string street(uint64_t seed, const std::string& wishes) {
  return fmt::format(R"(
greatx: 1
name: street
ticks: 30
tick_rate_hz: 10
{}
scene: {{generate: {{kind: canyon, seed: {}, size_m: 100}}}}
nodes:
  - name: mast
    trajectory: {{type: static, position_m: [6.3, -21.7, 9.4]}}
    sensors: [{{name: a, type: antenna, pattern: isotropic, polarization: v}}]
  - name: car
    trajectory:
      type: waypoints
      points: [{{t_s: 0, position_m: [2.4, -50, 1.5]}}, {{t_s: 3, position_m: [2.4, 10, 1.5]}}]
    sensors:
      - {{name: a, type: antenna, pattern: isotropic, polarization: v}}
      - {{name: scan, type: lidar, rate_hz: 10, channels: 16, elevation_min_deg: -20, elevation_max_deg: 10,
         azimuth_steps: 128, mount: {{position_m: [0, 0, 1]}}}}
channels:
  - {{name: csi, tx: mast/a, rx: car/a, rate_hz: 10, carrier_hz: 5e9, bandwidth_hz: 50e6, subcarriers: 32,
      max_depth: 2}}
)",
                     wishes, seed);
}

/// H of every tick of a scenario, one after the other.
class Responses : public RecordSink {
 public:
  explicit Responses(size_t sensor, size_t array) : sensor_(sensor), array_(array) {}
  void write(Packet packet) override {
    for (const Record& record : packet.records) {
      if (record.sensor != sensor_) continue;
      const auto h = record.arrays[array_].as<std::complex<float>>();
      values.insert(values.end(), h.begin(), h.end());
    }
  }
  std::vector<std::complex<float>> values;

 private:
  const size_t sensor_, array_;
};

std::vector<std::complex<float>> responses(gpu::Device& device, const Scenario& scenario) {
  const Experiment experiment = make_experiment(scenario);
  Simulator simulator(device, experiment);
  const auto& specs = simulator.sensors();
  const auto csi = std::ranges::find(specs, "csi", &SensorSpec::kind);
  const auto cfr = std::ranges::find(csi->arrays, "cfr", &ArraySpec::name);
  Responses sink(static_cast<size_t>(csi - specs.begin()), static_cast<size_t>(cfr - csi->arrays.begin()));
  simulator.start(0);
  while (simulator.step(sink)) {
  }
  return sink.values;
}

double nmse_db(const std::vector<std::complex<float>>& reference, const std::vector<std::complex<float>>& h) {
  double error = 0.0, power = 0.0;
  for (size_t i = 0; i < reference.size(); ++i) {
    const std::complex<double> a(reference[i]), b(h[i]);
    error += std::norm(b - a);
    power += std::norm(a);
  }
  return 10.0 * std::log10(error / power);
}

class Calibrations : public ::testing::Test {
 protected:
  static gpu::Device& device() { return test::device(); }
};

TEST_F(Calibrations, PromisesHoldOnUnseenScenes) {
  for (const uint64_t seed : {301, 302, 303}) {
    SCOPED_TRACE(seed);
    const Scenario scenario = parsed(street(seed, "accuracy: {csi_nmse_db: -15}"));
    const Experiment experiment = make_experiment(scenario);
    const Calibration calibration = calibrate(device(), experiment, {}, ignore);
    ASSERT_EQ(calibration.parts.size(), 1u);
    const CalibratedPart& part = calibration.parts[0];
    EXPECT_EQ(part.modality, Modality::csi);
    EXPECT_GE(part.checked_ticks, 8);
    const Scenario chosen = parsed(calibration.text);
    EXPECT_TRUE(chosen.accuracy.empty());
    std::vector<YamlChange> changes = without_wishes(scenario);
    changes.insert(changes.end(), part.reference_changes.begin(), part.reference_changes.end());
    const auto reference = responses(device(), changed(scenario, changes, {}));
    const auto got = responses(device(), chosen);
    ASSERT_EQ(got.size(), reference.size());
    ASSERT_FALSE(got.empty());
    EXPECT_LE(nmse_db(reference, got), -15.0);
    // What the check on other ticks has measured is of the order of the whole run's error.
    ASSERT_EQ(part.outcomes.size(), 1u);
    if (!part.finest && std::isfinite(part.outcomes[0].validated)) {
      EXPECT_NEAR(part.outcomes[0].validated, nmse_db(reference, got), 10.0);
    }
  }
}

TEST_F(Calibrations, WrittenKnobsStay) {
  const Scenario scenario = parsed(street(
      301, "accuracy: {csi_nmse_db: -3}\neffects: {diffraction: off, scattering: off, reflection: on}"));
  const Calibration calibration = calibrate(device(), make_experiment(scenario), {}, ignore);
  const Scenario chosen = parsed(calibration.text);
  EXPECT_EQ(chosen.effects.at("diffraction"), Switch::off);
  EXPECT_EQ(chosen.effects.at("scattering"), Switch::off);
  EXPECT_EQ(chosen.effects.at("reflection"), Switch::on);
  std::set<std::string> kept;
  for (const KeptKnob& knob : calibration.parts.at(0).kept)
    if (knob.why == "the scenario writes it") kept.insert(knob.knob);
  EXPECT_EQ(kept, (std::set<std::string>{"diffraction", "max_depth", "reflection", "scattering"}));
}

TEST_F(Calibrations, GuardOtherFiguresOfAModality) {
  const Calibration calibration =
      calibrate(device(), make_experiment(parsed(street(302, "accuracy: {lidar_range_m: 1}"))), {}, ignore);
  ASSERT_EQ(calibration.parts.size(), 1u);
  std::set<std::string_view> weighed;
  for (const TargetOutcome& outcome : calibration.parts[0].outcomes) {
    if (!outcome.target.asked) weighed.insert(outcome.target.kind->name);
    EXPECT_LE(outcome.validated, outcome.target.value) << outcome.target.kind->name;
  }
  EXPECT_EQ(weighed, (std::set<std::string_view>{"lidar_missed_percent", "lidar_intensity"}));
}

TEST_F(Calibrations, FillATimeBudgetOrSayWhatItTakes) {
  const Calibration calibration = calibrate(
      device(),
      make_experiment(parsed(street(303, "time_budget_ms_per_tick: 60000\neffects: {scattering: off}"))), {},
      ignore);
  EXPECT_EQ(calibration.parts.size(), 2u);  // csi and lidar
  EXPECT_GT(calibration.tick_ms.median, 0.0);
  EXPECT_LE(calibration.tick_ms.median, 60000.0);
  const Experiment tight =
      make_experiment(parsed(street(303, "time_budget_ms_per_tick: 0.001\neffects: {scattering: off}")));
  try {
    calibrate(device(), tight, {}, ignore);
    FAIL() << "expected UserError";
  } catch (const UserError& error) {
    EXPECT_NE(std::string(error.what()).find("time_budget_ms_per_tick: expected"), std::string::npos)
        << error.what();
  }
}

TEST_F(Calibrations, RefuseErrorsOfSensorsThatAreMissing) {
  const Experiment experiment = make_experiment(parsed(street(301, "accuracy: {rgb_flip: 0.1}")));
  EXPECT_THROW(calibrate(device(), experiment, {}, ignore), UserError);
}

TEST_F(Calibrations, StopWhenAsked) {
  const Experiment experiment = make_experiment(parsed(street(301, "accuracy: {csi_nmse_db: -10}")));
  int calls = 0;
  const auto stop = [&](const std::string&) {
    if (++calls == 3) throw Interrupted("test");
  };
  EXPECT_THROW(calibrate(device(), experiment, {}, stop), Interrupted);
}

TEST(CalibrationTicks, NoTickOfTheChoiceChecksIt) {
  for (const int64_t ticks : {1, 2, 5, 6, 8, 9, 10, 17, 30, 100, 997}) {
    Scenario scenario = parsed(street(301, ""));
    scenario.ticks = ticks;
    std::set<int64_t> chosen;
    const auto add = [](const MeasurePlan& plan, std::set<int64_t>& set) {
      for (const int64_t start : plan.starts)
        for (int64_t t = 0; t < plan.warm_up + plan.ticks; ++t) set.insert(start + t);
    };
    for (const Effort effort : {Effort::slow, Effort::singles, Effort::joint})
      add(calibration_ticks(scenario, effort), chosen);
    EXPECT_LT(*chosen.rbegin(), ticks);
    for (const Effort effort : {Effort::slow, Effort::singles, Effort::joint}) {
      const auto others = check_ticks(scenario, effort, false);
      EXPECT_EQ(others.has_value(), ticks >= 9) << ticks;
      if (!others) continue;
      std::set<int64_t> checked;
      add(*others, checked);
      EXPECT_LE(checked.size(), effort == Effort::slow ? 2u : 18u);
      EXPECT_LT(*checked.rbegin(), ticks);
      for (const int64_t tick : checked) EXPECT_FALSE(chosen.contains(tick)) << tick << " of " << ticks;
    }
  }
}

TEST(CalibrationTicks, SlowSensorsHaveRecordsInEveryBlock) {
  Scenario scenario = parsed(street(301, ""));
  scenario.tick_rate_hz = {1000, 1};
  scenario.ticks = 3000;  // 30 records at 10 Hz
  EXPECT_EQ(ticks_between_records(scenario), 100);
  for (const int64_t start : calibration_ticks(scenario, Effort::joint).starts) EXPECT_EQ(start % 100, 0);
  EXPECT_EQ(calibration_ticks(scenario, Effort::joint).starts.back(), 2700);
}

TEST(Confidence, OneSidedClopperAndPearson) {
  for (const int64_t n : {1, 5, 8, 59})
    EXPECT_NEAR(least_share(n, n), std::pow(0.05, 1.0 / static_cast<double>(n)), 1e-9);
  EXPECT_NEAR(least_share(8, 10), 0.49309869893679753, 1e-9);  // from the binomial sum
  EXPECT_EQ(least_share(0, 10), 0.0);
  EXPECT_EQ(least_share(0, 0), 0.0);
}

TEST(CalibrationWishes, ChangesReachTheSensorsOfTheWholeScenario) {
  const Scenario city = embedded("city");
  const Scenario radar = alone(city, Modality::radar, {}).value();
  const size_t node = 1;  // uav: front, events, lidar, radar, antenna
  ASSERT_EQ(radar.nodes[node].sensors[0].name, "radar");
  const std::vector<YamlChange> changes = for_whole(
      {{YamlChange::Kind::set, {"nodes", node, "sensors", size_t{0}, "updates"}, "2"}}, radar, city);
  EXPECT_EQ(yaml_path_text(changes[0].path), "nodes[1].sensors[3].updates");
}

}  // namespace
}  // namespace greatx::sim
