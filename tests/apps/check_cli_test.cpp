// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Runs `greatx check` on scenarios with and without faults.
#include <fstream>
#include <string>

#include <gmock/gmock.h>
#include <nlohmann/json.hpp>

#include "tests/apps/program.h"
#include "tests/support/temporary_folder.h"

namespace greatx::apps::test {
namespace {

using nlohmann::json;
using ::testing::HasSubstr;

std::string probe(const std::string& place, const std::string& pitch) {
  return fmt::format(R"(greatx: 1
name: probe
ticks: 4
tick_rate_hz: 10
scene: {{generate: {{kind: canyon, seed: 3, size_m: 60}}}}
environment: {{clouds: 0}}
nodes:
  - name: bs
    trajectory: {{type: static, position_m: [1, -20, 6]}}
    sensors: [{{name: a, type: antenna}}]
  - name: car
    trajectory: {{type: waypoints, points: [{{t_s: 0, position_m: {0}}}, {{t_s: 1, position_m: {0}}}]}}
    sensors:
      - {{name: a, type: antenna}}
      - {{name: lidar, type: lidar, rate_hz: 10, channels: 2, elevation_min_deg: -5, elevation_max_deg: 5,
         azimuth_steps: 16}}
      - {{name: cam, type: camera, rate_hz: 10, width: 48, height: 32, fov_deg: 30, outputs: [rgb],
         mount: {{rotation_deg: [90, {1}, 0]}}}}
channels:
  - {{name: csi, tx: bs/a, rx: [car/a], rate_hz: 10, bandwidth_hz: 20e6, subcarriers: 16, max_depth: 1}}
)",
                     place, pitch);
}

class CheckCli : public ::testing::Test {
 protected:
  Outcome check(const std::string& text, const std::string& more = "") const {
    std::ofstream(folder_ / "s.yaml") << text;
    return greatx(fmt::format("check {} {}", (folder_ / "s.yaml").string(), more));
  }
  greatx::test::TemporaryFolder temporary_;
  std::filesystem::path folder_ = temporary_.path();
};

TEST_F(CheckCli, AGoodScenarioHasNoFaultsAndItsCostIsPredicted) {
  const Outcome outcome = check(probe("[1, 10, 3]", "0"), "--json");
  ASSERT_EQ(outcome.code, 0) << outcome.out << outcome.err;
  const json found = json::parse(outcome.out);
  EXPECT_EQ(found["faults"], 0);
  EXPECT_EQ(found["links"][0]["without_path"], 0);
  EXPECT_EQ(found["links"][0]["moments"], 8);
  EXPECT_EQ(found["pictures"][0]["sensor"], "car/cam");
  EXPECT_GT(found["gigabytes"].get<double>(), 0.0);
  EXPECT_GT(found["hours"].get<double>(), 0.0);
  EXPECT_THAT(check(probe("[1, 10, 3]", "0")).out, HasSubstr("probe: no faults\n"));
}

TEST_F(CheckCli, WhoStandsInAHouseIsFoundAndTheRunWarnsToo) {
  const Outcome outcome = check(probe("[12, 10, 3]", "0"));
  EXPECT_EQ(outcome.code, 1);
  for (const char* sensor : {"car/a", "car/lidar", "car/cam"})
    EXPECT_THAT(outcome.out, HasSubstr(fmt::format("probe: fault: {} is inside '", sensor)));
  EXPECT_THAT(outcome.out, HasSubstr("probe: fault: csi has no path from bs/a to car/a at 8 of 8 moments"));
  const Outcome made =
      greatx(fmt::format("generate {} -o {} -q", (folder_ / "s.yaml").string(), (folder_ / "o").string()));
  EXPECT_EQ(made.code, 0);
  EXPECT_THAT(made.err, HasSubstr("car/lidar: is inside '"));
  EXPECT_THAT(made.err, HasSubstr("car/cam: 4 of 4 records are taken within something"));
}

TEST_F(CheckCli, ACameraOfTheSkyIsAFaultWithoutADevice) {
  const Outcome outcome = check(probe("[1, 10, 3]", "-90"), "--host --json");
  EXPECT_EQ(outcome.code, 1);
  const json found = json::parse(outcome.out);
  ASSERT_EQ(found["findings"].size(), 1u);
  EXPECT_EQ(found["findings"][0]["kind"], "only_sky");
  EXPECT_EQ(found["findings"][0]["subject"], "car/cam");
  EXPECT_TRUE(found["links"].empty());
  EXPECT_FALSE(found.contains("hours"));
}

TEST_F(CheckCli, AnOverexposedPictureIsAFault) {
  std::string text = probe("[1, 10, 3]", "0");
  text.replace(text.find("outputs: [rgb]"), 14, "outputs: [rgb], exposure: {ev100: -10}");
  const Outcome outcome = check(text, "--measure 0");
  EXPECT_EQ(outcome.code, 1) << outcome.err;
  EXPECT_THAT(outcome.out, HasSubstr("probe: fault: car/cam is white at 8 of 8 moments"));
}

TEST_F(CheckCli, ACampaignIsCheckedCellByCell) {
  std::ofstream(folder_ / "s.yaml") << probe("[1, 10, 3]", "0");
  std::ofstream(folder_ / "c.yaml")
      << "greatx_campaign: 1\nname: c\nbase: s.yaml\naxes:\n  place:\n    street: "
         "{}\n    house:\n      nodes[car].trajectory.points: [{t_s: 0, "
         "position_m: [12, 10, 3]}]\n";
  const Outcome outcome = greatx(fmt::format("check {} --host --json", (folder_ / "c.yaml").string()));
  EXPECT_EQ(outcome.code, 1) << outcome.err;
  const json found = json::parse(outcome.out);
  EXPECT_EQ(found["cells"][0]["faults"], 0) << found.dump(1);
  EXPECT_GT(found["cells"][1]["faults"], 0);
  EXPECT_EQ(found["faults"], found["cells"][1]["faults"]);
  const Outcome changed = greatx(fmt::format("check {} --ticks 3", (folder_ / "c.yaml").string()));
  EXPECT_EQ(changed.code, 1);
  EXPECT_THAT(changed.err, HasSubstr("expected a campaign alone"));
}

TEST_F(CheckCli, WhatIsNoScenarioIsAnError) {
  const Outcome outcome = greatx("check /nowhere.yaml");
  EXPECT_EQ(outcome.code, 1);
  EXPECT_THAT(outcome.err, HasSubstr("/nowhere.yaml: no such scenario"));
}

}  // namespace
}  // namespace greatx::apps::test
