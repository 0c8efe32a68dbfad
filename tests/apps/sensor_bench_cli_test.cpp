// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Tests that the rows of `greatx bench --lidar`, `--radar`, `--rig` and of the plain `greatx bench` exist and
// add up. The tests do not judge how long they take.
#include <cmath>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "tests/apps/program.h"
#include "tests/support/temporary_folder.h"

namespace greatx::apps::test {
namespace {

using ::testing::HasSubstr;
namespace fs = std::filesystem;

constexpr const char* head = R"(greatx: 1
name: rig
seed: 9
ticks: 6
tick_rate_hz: 10
scene:
  generate: {kind: room}
nodes:
  - name: drone
    trajectory: {type: waypoints, points: [{t_s: 0, position_m: [0.5, 0.3, 1.5]}, )"
                             R"({t_s: 1, position_m: [1, 0.3, 1.5]}]}
    sensors:
)";
constexpr const char* camera =
    "      - {name: front, type: camera, rate_hz: 10, width: 64, height: 48, fov_deg: 90}\n";
constexpr const char* lidar =
    "      - {name: lidar, type: lidar, rate_hz: 10, channels: 8, elevation_min_deg: -20, elevation_max_deg: "
    "20, "
    "azimuth_steps: 16, sweep_s: 0.05, beam: {divergence_mrad: 2, rings: 1}}\n";
constexpr const char* radar =
    "      - name: radar\n        type: radar\n        rate_hz: 10\n"
    "        waveform: {bandwidth_hz: 300e6, sample_rate_hz: 3e6, samples: 32, chirps: 16}\n"
    "        transmit: {pattern: isotropic}\n        receive: {pattern: isotropic, columns: 2}\n"
    "        echoes: {tubes: 60, antenna_radius_m: 0, max_echoes: 300}\n        receiver: "
    "{noise_figure_db: 12}\n";

class SensorBench : public ::testing::Test {
 protected:
  Outcome bench(const std::string& sensors, const std::string& options) const {
    std::ofstream(folder_ / "rig.yaml") << head + sensors;
    return greatx(fmt::format("bench {}/rig.yaml {}", folder_.string(), options));
  }
  nlohmann::json json(const std::string& sensors, const std::string& options) const {
    const Outcome outcome = bench(sensors, options + " --json");
    EXPECT_EQ(outcome.code, 0) << outcome.err;
    return nlohmann::json::parse(outcome.out);
  }
  greatx::test::TemporaryFolder temporary_;
  const fs::path folder_ = temporary_.path();
};

void expect_distribution(const nlohmann::json& d, size_t count) {
  EXPECT_EQ(d["count"], count);
  for (const char* key : {"min", "median", "max"}) EXPECT_TRUE(std::isfinite(d[key].get<double>())) << key;
  EXPECT_GT(d["min"], 0.0);
  EXPECT_LE(d["min"], d["median"]);
  EXPECT_LE(d["median"], d["max"]);
}

void expect_head(const nlohmann::json& json) {
  EXPECT_EQ(json["scenario"], "rig");
  EXPECT_FALSE(json["device"].get<std::string>().empty());
  EXPECT_FALSE(json["driver"].get<std::string>().empty());
}

TEST_F(SensorBench, LidarHasARowForEachEffectThatTheSceneCallsFor) {
  const nlohmann::json result = json(lidar, "--lidar --sweeps 2 --warm-up 1 --channels 4 --azimuth-steps 32");
  expect_head(result);
  EXPECT_EQ(result["lidar"], "drone/lidar");
  std::map<std::string, nlohmann::json> rows;
  for (const nlohmann::json& row : result["rows"]) {
    rows[row["name"]] = row;
    expect_distribution(row["tick_ms"], 2);
    expect_distribution(row["cpu_ms"], 2);
    EXPECT_GT(row["ratio"], 0.0);
    EXPECT_GT(row["returns"], 0.0);
    EXPECT_EQ(row["shots"], 128);
  }
  const auto of = [&](const std::string& name) { return rows.at(name); };
  const nlohmann::json plain = of("4 x 32 single rays");
  EXPECT_EQ(plain, result["rows"][0]);
  EXPECT_TRUE(plain["effects"].empty());
  EXPECT_EQ(plain["ratio"], 1.0);
  EXPECT_EQ(plain["rays"], 1);
  EXPECT_EQ(plain["returns"], 128.0) << "a closed room";
  EXPECT_EQ(of("+ 1 ring, 7 rays")["rays"], 7);
  EXPECT_EQ(of("+ 2 rings, 19 rays")["rays"], 19);
  EXPECT_EQ(of("+ 1 ring, 7 rays")["returns"], 128.0);
  EXPECT_GE(of("+ 1 ring, all returns")["returns"], of("+ 1 ring, dual returns")["returns"]);
  EXPECT_GE(of("+ 1 ring, dual returns")["returns"], 128.0);
  EXPECT_EQ(of("+ shots at their own times")["effects"], nlohmann::json::array({"lidar_sweep_motion"}));
  EXPECT_EQ(of("+ fog's own echoes, detection")["effects"],
            nlohmann::json::array({"lidar_haze", "lidar_backscatter", "lidar_detection"}));
  EXPECT_EQ(of("as in the scenario")["shots"], 128);
  EXPECT_EQ(of("as in the scenario")["rays"], 7);
  // Every row is measured or left out with a reason. Nothing moves in this scenario.
  EXPECT_EQ(result["left_out"]["bodies at their times too"], "no mesh moves");
  EXPECT_EQ(result["rows"].size() + result["left_out"].size(), 16u);
}

TEST_F(SensorBench, RadarTellsTheCostAndTheErrorOfTubes) {
  const nlohmann::json result = json(radar, "--radar --frames 2 --warm-up 1");
  expect_head(result);
  EXPECT_EQ(result["radar"], "drone/radar");
  EXPECT_EQ(result["transmitters"], 1);
  EXPECT_EQ(result["receivers"], 2);
  EXPECT_EQ(result["chirps"], 16);
  EXPECT_EQ(result["samples"], 32);
  EXPECT_GT(result["cells"], 0);
  ASSERT_EQ(result["frames"].size(), 7u);
  EXPECT_EQ(result["frames"][0]["name"], "as in the scenario");
  EXPECT_EQ(result["frames"][0]["ratio"], 1.0);
  for (const nlohmann::json& row : result["frames"]) {
    for (const char* key : {"frame_ms", "echoes_ms", "signal_ms", "cpu_ms"}) expect_distribution(row[key], 2);
    EXPECT_LE(row["echoes_ms"]["min"], row["frame_ms"]["min"]);
    EXPECT_GT(row["echoes"], 0.0) << row["name"];
  }
  ASSERT_EQ(result["echoes"].size(), 6u);
  double tubes = 0.0;
  for (const nlohmann::json& row : result["echoes"]) {
    EXPECT_GT(row["tubes"], tubes) << "in order of tubes";
    tubes = row["tubes"];
    EXPECT_GT(row["echoes"], 0.0);
    EXPECT_GT(row["echoes_ms"]["min"], 0.0);
    if (row["factor"] == result["reference_factor"]) continue;
    EXPECT_TRUE(std::isfinite(row["q90_db"].get<double>()));
    EXPECT_GE(row["q90_db"], row["median_db"]);
    EXPECT_GE(row["median_db"], 0.0);
  }
  EXPECT_EQ(result["echoes"].back()["factor"], result["reference_factor"]);
}

TEST_F(SensorBench, TheRigTellsWhatEachSensorCosts) {
  const std::string channel =
      "      - {name: antenna, type: antenna, mount: {position_m: [0, 0, 0.2]}}\n"
      "  - name: bs\n    trajectory: {type: static, position_m: [-0.5, -0.4, 2]}\n"
      "    sensors: [{name: antenna, type: antenna}]\n"
      "channels:\n  - {name: csi, tx: bs/antenna, rx: [drone/antenna], rate_hz: 10, carrier_hz: 3.5e9, "
      "subcarriers: 8, bandwidth_hz: 20e6, max_depth: 1}\n";
  const nlohmann::json result =
      json(std::string(lidar) + radar + channel, "--rig --rounds 3 --block 2 --warm-up 1");
  expect_head(result);
  EXPECT_EQ(result["rounds"], 2) << "six ticks: one to warm up and two rounds of two";
  std::vector<std::string> names;
  for (const nlohmann::json& row : result["rows"]) {
    names.push_back(row["name"]);
    expect_distribution(row["wall_ms"], 2);
    expect_distribution(row["cpu_ms"], 2);
    if (names.size() == 1) continue;
    EXPECT_TRUE(std::isfinite(row["cost_wall_ms"].get<double>()));
    EXPECT_TRUE(std::isfinite(row["cost_cpu_ms"].get<double>()));
  }
  EXPECT_THAT(names, ::testing::ElementsAre("all, written", "nothing written", "without LiDAR drone/lidar",
                                            "without radar drone/radar", "without channel csi"));
}

TEST_F(SensorBench, TheRigTellsWhatMovingBodiesCost) {
  const nlohmann::json result =
      json(std::string(lidar) + camera, "--rig --bodies 1,12 --rounds 2 --block 2 --warm-up 1");
  expect_head(result);
  ASSERT_EQ(result["rows"].size(), 2u);
  EXPECT_EQ(result["rows"][0]["name"], "1 moving cars more");
  EXPECT_EQ(result["rows"][1]["name"], "12 moving cars more");
  EXPECT_FALSE(result["rows"][0].contains("cost_cpu_ms"));
  EXPECT_TRUE(std::isfinite(result["rows"][1]["cost_cpu_ms"].get<double>()));
  for (const nlohmann::json& row : result["rows"]) expect_distribution(row["wall_ms"], 2);
}

TEST_F(SensorBench, TheRigPrintsATable) {
  const Outcome text = bench(lidar, "--rig --rounds 1 --block 1 --warm-up 0");
  EXPECT_EQ(text.code, 0) << text.err;
  for (const char* part : {"rig on ", "all, written", "without LiDAR drone/lidar", "it costs"})
    EXPECT_THAT(text.out, HasSubstr(part));
}

TEST_F(SensorBench, ThePlainBenchHasRowsOfTheHost) {
  const nlohmann::json result = json(std::string(lidar) + radar, "--warm-up 2 --discard");
  for (const char* row : {"record drone/lidar", "collect drone/lidar", "record drone/radar",
                          "collect drone/radar", "collect poses", "wait", "compare", "hand over"}) {
    ASSERT_TRUE(result["host_ms"].contains(row)) << row;
    EXPECT_EQ(result["host_ms"][row]["count"], 4) << row << ": six ticks, two to warm up";
    EXPECT_GE(result["host_ms"][row]["min"], 0.0);
  }
  EXPECT_GT(result["host_ms"]["collect drone/radar"]["min"], 0.0);
}

TEST_F(SensorBench, WhatIsMissingIsNamed) {
  const auto expect = [&](const std::string& sensors, const std::string& options,
                          const std::string& message) {
    const Outcome outcome = bench(sensors, options);
    EXPECT_EQ(outcome.code, 1) << options;
    EXPECT_THAT(outcome.err, HasSubstr(message));
  };
  expect(camera, "--lidar", "rig: bench --lidar: expected a LiDAR, found none");
  expect(camera, "--radar", "rig: bench --radar: expected a radar, found none");
  expect(lidar, "--camera", "rig: bench --camera: expected a camera, found none");
  expect("      - {name: antenna, type: antenna}\n", "--rig",
         "rig: bench --rig: expected 13 ticks at least, 5 to warm up and 8 of a block, found 6");
  expect("      - {name: antenna, type: antenna}\n", "--rig --block 1",
         "rig: bench --rig: expected a sensor or a channel, found none");
  EXPECT_NE(bench(lidar, "--lidar --rig").code, 0) << "one at a time";
}

}  // namespace
}  // namespace greatx::apps::test
