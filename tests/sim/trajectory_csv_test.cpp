// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "sim/scenario/parse/trajectory_csv.h"

#include <filesystem>

#include <gtest/gtest.h>

namespace greatx::sim {
namespace {

std::string csv_refusal(const std::string& text) {
  try {
    parse_way_points(text, "f.csv");
  } catch (const UserError& error) {
    return error.what();
  }
  return "accepted";
}

TEST(WayPointCsv, ReadsPositions) {
  const auto points = parse_way_points("0,1,2,3\n 1.5 , -4e1, +5,\t.5\n", "f.csv");
  ASSERT_EQ(points.size(), 2u);
  EXPECT_EQ(points[1].time_s, 1.5);
  EXPECT_EQ(points[1].position_m, dvec3(-40, 5, 0.5));
  EXPECT_FALSE(points[0].orientation);
}

TEST(WayPointCsv, ReadsAttitude) {
  const auto points = parse_way_points("0,0,0,0,90,0,0\n", "f.csv");
  EXPECT_NEAR(glm::distance(*points[0].orientation * dvec3(1, 0, 0), dvec3(0, 1, 0)), 0.0, 1e-15);
}

TEST(WayPointCsv, HeaderCommentsBlankLinesAndWindowsEndsAreFine) {
  const auto points = parse_way_points(
      "\xEF\xBB\xBF# log\r\n\r\nTime_s, x_m, y_m, z_m\r\n0,0,0,1\r\n  # half\r\n1,0,0,2", "f.csv");
  ASSERT_EQ(points.size(), 2u);
  EXPECT_EQ(points[1].position_m.z, 2.0);
}

TEST(WayPointCsv, FaultsNameLineAndColumn) {
  EXPECT_EQ(csv_refusal(""), "f.csv: expected one way-point or more, found none");
  EXPECT_EQ(csv_refusal("# nothing\nt,x,y,z\n"), "f.csv: expected one way-point or more, found none");
  EXPECT_EQ(csv_refusal("0,0,0,0\n1, 0, north, 0\n"),
            "f.csv:2:7: y: expected a finite number, found 'north'");
  EXPECT_EQ(csv_refusal("0,0,0,nan\n"), "f.csv:1:7: z: expected a finite number, found 'nan'");
  EXPECT_EQ(csv_refusal("nan,0,0,0\n"), "f.csv:1:1: t: expected a finite number, found 'nan'");
  EXPECT_EQ(csv_refusal("0,0,inf,0\n"), "f.csv:1:5: y: expected a finite number, found 'inf'");
  EXPECT_EQ(csv_refusal("0,0,,0\n"), "f.csv:1:5: y: expected a finite number, found ''");
  EXPECT_EQ(csv_refusal("# c\n0,0,0,0\n0,1,1,1\n"),
            "f.csv:3:1: t: expected a time greater than the one before, 0, found '0'");
  EXPECT_EQ(csv_refusal("0,0,0\n"),
            "f.csv:1:5: expected 4 or 7 values (t, x, y, z[, yaw_deg, pitch_deg, roll_deg]), found 3");
  EXPECT_EQ(csv_refusal("0,0,0,0\n1,0,0,0,0,0,0\n"),
            "f.csv:2:13: expected 4 values as in the lines before, found 7");
  EXPECT_EQ(csv_refusal("t,x,y,z\n1,0,0,0,0,0,0\n"),
            "f.csv:2:13: expected 4 values as in the lines before, found 7");
  EXPECT_EQ(csv_refusal("x,y,z,t\n"), "f.csv:1:1: t: expected a number, or 't' in a header line, found 'x'");
  EXPECT_EQ(csv_refusal("t,x,y,z\nt,x,y,z\n"),
            "f.csv:2:1: t: expected a finite number of seconds, or a date and time with its offset such as "
            "2026-06-21T12:00:00Z, found 't'");
  EXPECT_EQ(csv_refusal("0;0;0;0\n"),
            "f.csv:1:1: expected 4 or 7 values (t, x, y, z[, yaw_deg, pitch_deg, roll_deg]), found 1");
}

TEST(WayPointCsv, FaultsInAScenariosFileNameTheCsv) {
  EXPECT_THROW(load_way_points(std::filesystem::path(GREATX_SCENARIOS) / "missing.csv"), UserError);
}

}  // namespace
}  // namespace greatx::sim
