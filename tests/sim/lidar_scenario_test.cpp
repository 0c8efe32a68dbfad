// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Tests LiDARs as written in scenarios, and tables of shots.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/error.h"
#include "sim/scenario/parse/load_scenario.h"
#include "sim/scenario/parse/shot_csv.h"
#include "sim/scenario/scenario.h"

namespace greatx::sim {
namespace {

const std::filesystem::path folder = GREATX_SCENARIOS;

TEST(LidarScenario, EveryFieldIsRead) {
  const Scenario scenario = load_scenario(folder / "lidars.yaml");
  const auto lidar = [&](size_t i) { return std::get<LidarConfig>(scenario.nodes[0].sensors[i].config); };
  const LidarConfig spinning = lidar(0);
  EXPECT_EQ(std::get<render::SpinningScan>(spinning.scan).elevations.size(), 3u);
  EXPECT_EQ(spinning.rings, 0u);
  EXPECT_EQ(spinning.returns.mode, render::ReturnMode::strongest);
  EXPECT_FALSE(spinning.receiver.noisy());
  EXPECT_TRUE(spinning.outputs.points && spinning.outputs.ply && !spinning.outputs.pcd &&
              !spinning.outputs.kitti);

  const LidarConfig raster = lidar(1);
  const auto& lines = std::get<render::RasterScan>(raster.scan);
  EXPECT_EQ(lines.columns, 40u);
  EXPECT_EQ(lines.rows, 30u);
  EXPECT_DOUBLE_EQ(lines.azimuth_first, radians(20.0));
  EXPECT_DOUBLE_EQ(lines.azimuth_last, radians(-20.0));
  EXPECT_DOUBLE_EQ(lines.elevation_last, radians(10.0));
  EXPECT_TRUE(lines.alternate);
  EXPECT_EQ(lines.sweep_s, 0.05);
  EXPECT_DOUBLE_EQ(raster.divergence, 0.003);
  EXPECT_EQ(raster.rings, 2u);
  EXPECT_EQ(raster.returns.mode, render::ReturnMode::all);
  EXPECT_EQ(raster.returns.most, 4u);
  EXPECT_EQ(raster.returns.resolution_m, 0.5);
  EXPECT_EQ(raster.receiver.aperture_diameter_m, 0.03);
  EXPECT_EQ(raster.receiver.system_efficiency, 0.8);
  EXPECT_EQ(raster.receiver.range_std_m, 0.02);
  EXPECT_EQ(raster.receiver.rise_m, 0.3);
  ASSERT_TRUE(raster.receiver.detection);
  EXPECT_EQ(raster.receiver.detection->threshold, 4.0);
  // A target of 20 % reflectance at 100 m is detected with a probability of 80 %.
  EXPECT_NEAR(
      render::normal_cdf(0.2 * 9e-4 * 0.8 / 4e4 / raster.receiver.detection->noise_equivalent_power - 4.0),
      0.8, 1e-12);
  EXPECT_TRUE(raster.outputs.pcd && raster.outputs.kitti);

  const LidarConfig rosette = lidar(2);
  const auto& prisms = std::get<render::RosetteScan>(rosette.scan);
  EXPECT_EQ(prisms.shots, 10'000u);
  EXPECT_DOUBLE_EQ(prisms.deflections[1], radians(9.5));
  EXPECT_EQ(prisms.rotations_hz[1], -77.7);
  EXPECT_DOUBLE_EQ(prisms.phases[1], radians(30.0));
  EXPECT_EQ(rosette.returns.mode, render::ReturnMode::dual);
  EXPECT_EQ(rosette.receiver.detection->noise_equivalent_power, 1e-11);
  EXPECT_EQ(rosette.receiver.detection->threshold, 5.0);

  const LidarConfig table = lidar(3);
  const auto& shots = std::get<render::ShotTable>(table.scan);
  ASSERT_EQ(shots.shots.size(), 4u);
  EXPECT_EQ(shots.file, "shots.csv");
  EXPECT_EQ(shots.sha256.size(), 64u);
  EXPECT_EQ(shots.shots[2].time_s, 0.001);
  EXPECT_DOUBLE_EQ(shots.shots[2].azimuth, radians(9.5));
  EXPECT_DOUBLE_EQ(shots.shots[2].elevation, radians(-5.0));
  EXPECT_EQ(shots.shots[3].channel, 1);
  EXPECT_EQ(table.returns.mode, render::ReturnMode::last);
}

std::string message_of(const std::string& csv) {
  try {
    parse_shots(csv, "shots.csv");
  } catch (const UserError& error) {
    return error.what();
  }
  return "accepted";
}

TEST(ShotTable, BadLinesAreNamedByNumberAndColumn) {
  EXPECT_EQ(message_of("0,1,2\n0.5,1,2\n"), "accepted");
  EXPECT_EQ(message_of("\xEF\xBB\xBF# mine\r\nt_s,azimuth_deg,elevation_deg\r\n\r\n0,1,2\r\n"), "accepted");
  EXPECT_EQ(message_of(""), "shots.csv: expected one shot or more, found none");
  EXPECT_EQ(message_of("t_s,azimuth_deg,elevation_deg\n"),
            "shots.csv: expected one shot or more, found none");
  EXPECT_EQ(message_of("t_s,elevation_deg,azimuth_deg\n0,1,2\n"),
            "shots.csv:1:5: azimuth_deg: expected a number, or 'azimuth_deg' in a header line, found "
            "'elevation_deg'");
  EXPECT_EQ(message_of("0,1\n"),
            "shots.csv:1:3: expected 3 or 4 values (t_s, azimuth_deg, elevation_deg[, channel]), found 2");
  EXPECT_EQ(message_of("0,1,2\n0,1,2,3\n"),
            "shots.csv:2:7: expected 3 values as in the lines before, found 4");
  EXPECT_EQ(message_of("0,1,2\n0,east,2\n"),
            "shots.csv:2:3: azimuth_deg: expected an azimuth from -360 to 360, found 'east'");
  EXPECT_EQ(message_of("0,1,2\n0,nan,2\n"),
            "shots.csv:2:3: azimuth_deg: expected an azimuth from -360 to 360, found 'nan'");
  EXPECT_EQ(message_of("0,1,91\n"),
            "shots.csv:1:5: elevation_deg: expected an elevation from -90 to 90, found '91'");
  EXPECT_EQ(message_of("-1,1,2\n"),
            "shots.csv:1:1: t_s: expected a time after the tick of 0 or more, found '-1'");
  EXPECT_EQ(message_of("0.5,1,2\n\n0.4,1,2\n"),
            "shots.csv:3:1: t_s: expected a time not before the one before, 0.5, found '0.4'");
  EXPECT_EQ(message_of("0,1,2,0.5\n"),
            "shots.csv:1:7: channel: expected a whole number from 0 to 65534, found '0.5'");
}

TEST(ShotTable, LastsNoLongerThanAPeriod) {
  const std::string text =
      "greatx: 1\nname: x\nticks: 5\ntick_rate_hz: 10000\nnodes:\n  - name: a\n    trajectory: {type: "
      "static, position_m: "
      "[0, 0, 0]}\n    sensors:\n      - {name: l, type: lidar, rate_hz: 2000, shots_file: shots.csv}\n";
  try {
    parse_scenario(text, "s.yaml", folder);
    FAIL() << "accepted";
  } catch (const UserError& error) {
    EXPECT_THAT(error.what(), ::testing::HasSubstr(
                                  "s.yaml:9: nodes[0].sensors[0].shots_file: expected times of at most one "
                                  "period, 0.0005 s, found a last one of 0.001 s"));
  }
}

}  // namespace
}  // namespace greatx::sim
