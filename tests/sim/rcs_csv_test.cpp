// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Reads tables of scattering, and refuses those with gaps.
#include "sim/scenario/parse/rcs_csv.h"

#include <cmath>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/error.h"
#include "core/units.h"

namespace greatx::sim {
namespace {

using ::testing::HasSubstr;

std::string rcs_refusal(const std::string& text) {
  try {
    parse_rcs_csv(text, "t.csv");
  } catch (const UserError& error) {
    return error.what();
  }
  return "accepted";
}

const std::string monostatic =
    "theta_deg,phi_deg,rcs_dbsm\n0,0,1\n0,180,1\n90,0,2\n90,180,-inf\n180,0,1\n180,180,1\n";

TEST(RcsCsv, ATableOfCrossSections) {
  const auto table = parse_rcs_csv(monostatic, "folder/t.csv");
  EXPECT_FALSE(table->bistatic());
  EXPECT_EQ(table->name(), "t.csv");
  EXPECT_EQ(table->sha256().size(), 64u);
  const rf::ScatterMatrix front = table->scatter({{1, 0, 0}, {1, 0, 0}}, {});
  EXPECT_NEAR(10.0 * std::log10(4.0 * pi * std::norm(front[0])), 2.0, 1e-12);
  EXPECT_EQ(front[0], front[3]);
  EXPECT_EQ(front[1], rf::Complex(0.0));
  EXPECT_EQ(table->scatter({{-1, 0, 0}, {-1, 0, 0}}, {})[0], rf::Complex(0.0));
}

TEST(RcsCsv, ATableOfMatricesOnceAround) {
  std::string text = "# comment\ntheta_deg,phi_deg,s_tt_re,s_tt_im,s_tp_re,s_tp_im,s_pp_re,s_pp_im\n";
  for (const int theta : {0, 90, 180})
    for (const int phi : {-180, -90, 0, 90, 180})
      text += fmt::format("{},{},1,2,0.5,-0.5,3,{}\n", theta, phi, theta);
  const rf::ScatterMatrix s = parse_rcs_csv(text, "t.csv")->scatter({{0, 1, 0}, {0, 1, 0}}, {});
  EXPECT_EQ(s[0], rf::Complex(1, 2));
  EXPECT_EQ(s[1], rf::Complex(0.5, -0.5));
  EXPECT_EQ(s[2], s[1]);
  EXPECT_NEAR(std::abs(s[3] - rf::Complex(3, 90)), 0.0, 1e-12);
}

TEST(RcsCsv, ABistaticTable) {
  std::string text = "theta_in_deg,phi_in_deg,theta_out_deg,phi_out_deg,rcs_dbsm\n";
  for (const int a : {0, 90, 180})
    for (const int b : {0, 120, 240})
      for (const int c : {0, 180})
        for (const int d : {0, 90, 180, 270})
          text += fmt::format("{},{},{},{},{}\n", a, b, c, d, a / 10 + b / 120);
  const auto table = parse_rcs_csv(text, "t.csv");
  EXPECT_TRUE(table->bistatic());
  const double db = 10.0 * std::log10(4.0 * pi * std::norm(table->scatter({{1, 0, 0}, {0, 0, 1}}, {})[0]));
  EXPECT_NEAR(db, 9.0, 1e-9);
}

TEST(RcsCsv, FaultsAreNamed) {
  const auto with = [](std::string text, const std::string& what, const std::string& by) {
    return text.replace(text.find(what), what.size(), by);
  };
  EXPECT_EQ(rcs_refusal(with(monostatic, "90,180,-inf\n", "")),
            "t.csv:4: theta_deg 90, phi_deg 180: expected a line, found none (a gap)");
  EXPECT_EQ(rcs_refusal(with(monostatic, "90,180,-inf\n", "90,180,1\n90,180,2\n")),
            "t.csv:6: theta_deg 90, phi_deg 180: expected every direction once, found a second line like 5");
  EXPECT_THAT(rcs_refusal(with(monostatic, "90,180,-inf", "90,180,")),
              HasSubstr("expected a finite number, found a gap"));
  EXPECT_THAT(rcs_refusal(with(monostatic, "90,180,-inf", "90,180,nan")), HasSubstr("t.csv:5:8: rcs_dbsm"));
  EXPECT_THAT(rcs_refusal(with(monostatic, "180,0,1\n180,180,1\n", "")),
              HasSubstr("expected zeniths from 0 to 180, found them from 0 to 90"));
  EXPECT_THAT(rcs_refusal("theta_deg,phi_deg,gain_dbi\n0,0,0\n"), HasSubstr("expected the header"));
  EXPECT_THAT(rcs_refusal("theta_deg,phi_deg,rcs_dbsm\n"), HasSubstr("found none"));
  EXPECT_THAT(rcs_refusal("theta_deg,phi_deg,rcs_dbsm\n0,0,1\n0,90,1\n180,0,1\n180,90,1\n"),
              HasSubstr("expected azimuths once around (360 degrees), found 2 from 0 to 90"));
  EXPECT_THAT(rcs_refusal("theta_deg,phi_deg,rcs_dbsm\n0,0,1\n200,0,1\n"),
              HasSubstr("a zenith from 0 to 180"));
  EXPECT_THAT(rcs_refusal("theta_deg,phi_deg,rcs_dbsm\n0,0,1\n70,0,1\n180,0,1\n"),
              HasSubstr("expected even steps"));
  EXPECT_THAT(rcs_refusal("theta_deg,phi_deg,rcs_dbsm\n0,0,1\n180,0,300\n"), HasSubstr("at most 200 dBsm"));
  EXPECT_THAT(rcs_refusal("theta_deg,phi_deg,rcs_dbsm\n0,0\n"), HasSubstr("expected 3 values"));
  // A list in which every line has its own angles is no grid, and takes no memory of one.
  std::string wild = "theta_in_deg,phi_in_deg,theta_out_deg,phi_out_deg,rcs_dbsm\n";
  for (int i = 0; i <= 3600; ++i)
    wild += fmt::format("{},{},{},{},0\n", i / 20.0, i / 10.0, 180.0 - i / 20.0, i / 10.0);
  EXPECT_THAT(rcs_refusal(wild), HasSubstr("3601 x 3601 x 3601 x 3601, found 3601 lines"));
}

}  // namespace
}  // namespace greatx::sim
