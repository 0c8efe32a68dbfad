// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "sim/scenario/parse/pattern_csv.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/error.h"
#include "core/hash.h"
#include "core/units.h"
#include "rf/antenna/element.h"

namespace greatx::sim {
namespace {

using ::testing::HasSubstr;

std::string refusal_of(const std::string& text) {
  try {
    parse_pattern_csv(text, "p.csv");
  } catch (const UserError& error) {
    return error.what();
  }
  return "accepted";
}

constexpr const char* gain_header = "theta_deg,phi_deg,gain_dbi";
constexpr const char* field_header = "theta_deg,phi_deg,f_theta_re,f_theta_im,f_phi_re,f_phi_im";

/// Returns the lines of a grid in steps of 45 degrees. The first one is line 2 of the file.
std::vector<std::string> lines(const std::function<std::string(double, double)>& value, double first = 0.0,
                               double last = 315.0) {
  std::vector<std::string> out;
  for (double theta = 0.0; theta <= 180.0; theta += 45.0)
    for (double phi = first; phi <= last; phi += 45.0)
      out.push_back(fmt::format("{},{},{}", theta, phi, value(theta, phi)));
  return out;
}

std::string file(const std::string& header, const std::vector<std::string>& rows) {
  std::string text = header + "\n";
  for (const std::string& row : rows) text += row + "\n";
  return text;
}

std::string flat(double, double) { return "3"; }
/// Returns a different complex number for every direction, the same at both ends of the circle. Its magnitude
/// at the poles is 0.5.
std::string field_at(double theta, double phi) {
  const bool pole = theta == 0.0 || theta == 180.0;
  const double turn = std::fmod(phi + 360.0, 360.0);
  return pole ? "0.3,0,0,-0.4"
              : fmt::format("{},{},{},{}", theta / 100.0, turn / 1000.0, -turn / 500.0, theta / 300.0);
}

TEST(PatternCsv, GainsAreVerticalAmplitudes) {
  const rf::PatternTable table = parse_pattern_csv(file(gain_header, lines(flat)), "folder/p.csv");
  EXPECT_EQ(table.grid().zeniths, 5u);
  EXPECT_EQ(table.grid().azimuths, 8u);
  EXPECT_EQ(table.name(), "p.csv");
  for (const rf::Jones& sample : table.samples()) {
    EXPECT_NEAR(10.0 * std::log10(std::norm(sample.theta)), 3.0, 1e-12);
    EXPECT_EQ(sample.phi, 0.0);
  }
}

TEST(PatternCsv, FieldsInAnyOrderFromAnyMeridian) {
  // The same sphere starts at 0, at -180, and at -180 with the meridian repeated at +180. Its lines are
  // shuffled.
  std::vector<rf::PatternTable> tables;
  for (const auto& [first, last] :
       {std::pair(0.0, 315.0), std::pair(-180.0, 135.0), std::pair(-180.0, 180.0)}) {
    std::vector<std::string> rows = lines(field_at, first, last);
    std::reverse(rows.begin(), rows.end());
    std::rotate(rows.begin(), rows.begin() + 7, rows.end());
    tables.push_back(parse_pattern_csv(file(field_header, rows), "p.csv"));
    EXPECT_EQ(tables.back().grid().azimuths, 8u);
    EXPECT_NEAR(tables.back().grid().first_azimuth, radians(first), 1e-15);
  }
  for (double theta = 0.0; theta <= pi; theta += 0.1)
    for (double phi = -7.0; phi <= 7.0; phi += 0.3) {
      const rf::Jones reference = tables[0].at(std::min(theta, pi), phi);
      for (const rf::PatternTable& table : tables) {
        const rf::Jones ours = table.at(std::min(theta, pi), phi);
        EXPECT_LT(std::abs(ours.theta - reference.theta) + std::abs(ours.phi - reference.phi), 1e-13);
      }
    }
  const rf::Jones sample = tables[1].at(radians(90.0), radians(-90.0));
  EXPECT_LT(std::abs(sample.theta - rf::Complex(0.9, 0.27)) + std::abs(sample.phi - rf::Complex(-0.54, 0.3)),
            1e-13);
}

TEST(PatternCsv, CommentsWindowsEndsAndNullsAreFine) {
  const auto dipole = [](double theta, double) { return theta == 0.0 || theta == 180.0 ? "-inf" : "0"; };
  std::string text = "\xEF\xBB\xBF# measured\r\n\r\nTheta_deg, Phi_deg, Gain_dBi\r\n";
  for (const std::string& row : lines(dipole)) text += row + "\r\n";
  const rf::PatternTable table = parse_pattern_csv(text, "p.csv");
  EXPECT_EQ(table.at(0.0, 1.0).theta, 0.0);
  EXPECT_NEAR(table.at(pi / 2, 1.0).theta.real(), 1.0, 1e-15);
  EXPECT_EQ(table.sha256(), Sha256().update(text).hex());
}

TEST(PatternCsv, AnglesWithFewDigitsAreEven) {
  std::string text = std::string(gain_header) + "\n";
  for (int i = 0; i <= 27; ++i)
    for (int j = 0; j < 54; ++j) text += fmt::format("{:.2f},{:.2f},0\n", i * 180.0 / 27.0, j * 360.0 / 54.0);
  EXPECT_EQ(parse_pattern_csv(text, "p.csv").grid().azimuths, 54u);
}

TEST(PatternCsv, Tr38901IsAcceptedThoughItsPolesDependOnAzimuth) {
  const auto gain = [](double theta, double phi) {
    const double v = (theta - 90.0) / 65.0, h = (phi > 180.0 ? phi - 360.0 : phi) / 65.0;
    return fmt::format("{:.6f}", 8.0 - std::min(12.0 * v * v + 12.0 * h * h, 30.0));
  };
  EXPECT_EQ(refusal_of(file(gain_header, lines(gain))), "accepted");
}

TEST(PatternCsv, FaultsNameLineColumnAndField) {
  std::vector<std::string> rows = lines(flat);  // line 2 + 8 i + j holds theta = 45 i, phi = 45 j
  const auto with = [&](size_t row, const std::string& text) {
    std::vector<std::string> changed = rows;
    changed[row] = text;
    return refusal_of(file(gain_header, changed));
  };
  EXPECT_EQ(with(9, "45,45,"), "p.csv:11:7: gain_dbi: expected a finite number, found a gap");
  EXPECT_EQ(with(9, "45,45,nan"), "p.csv:11:7: gain_dbi: expected a finite number, found 'nan'");
  EXPECT_EQ(with(9, "45,45,inf"), "p.csv:11:7: gain_dbi: expected a finite number, found 'inf'");
  EXPECT_EQ(with(9, "45,-inf,0"), "p.csv:11:4: phi_deg: expected a finite number, found '-inf'");
  EXPECT_EQ(with(9, "45,45,8 dBi"), "p.csv:11:7: gain_dbi: expected a finite number, found '8 dBi'");
  EXPECT_EQ(with(9, "45,45,120"), "p.csv:11:7: gain_dbi: expected a gain of at most 100 dBi, found '120'");
  EXPECT_EQ(with(9, "45,45"), "p.csv:11:4: expected 3 values (theta_deg, phi_deg, gain_dbi), found 2");
  EXPECT_EQ(with(9, "-45,45,0"), "p.csv:11:1: theta_deg: expected a zenith from 0 to 180 (0: up), found -45");
  EXPECT_EQ(with(9, "45,405,0"), "p.csv:11:4: phi_deg: expected an azimuth from -360 to 360, found 405");
  EXPECT_EQ(with(9, "45,90,3"),
            "p.csv:12: theta_deg 45, phi_deg 90: expected every direction once, found a second line like 11");
  EXPECT_EQ(with(9, "50,45,3"), "p.csv:11: theta_deg: expected even steps, 90 after 45, found 50");
  EXPECT_EQ(with(9, "45,50,3"), "p.csv:11: phi_deg: expected even steps, 90 after 45, found 50");
  EXPECT_EQ(with(3, "0,135,-30"),
            "p.csv:5: theta_deg 0, phi_deg 135: expected the strength of phi_deg 0 (line 2) at a pole, which "
            "is one "
            "direction, found an amplitude gain of 0.03162 beside 1.413");
  EXPECT_EQ(with(38, "180,270,9"),
            "p.csv:40: theta_deg 180, phi_deg 270: expected the strength of phi_deg 0 (line 34) at a pole, "
            "which is one "
            "direction, found an amplitude gain of 2.818 beside 1.413");
}

TEST(PatternCsv, LessThanTheWholeSphereIsRefused) {
  std::vector<std::string> rows = lines(flat);
  std::vector<std::string> gap = rows;
  gap.erase(gap.begin() + 9);
  EXPECT_EQ(refusal_of(file(gain_header, gap)),
            "p.csv:10: theta_deg 45, phi_deg 45: expected a line, found none");
  std::vector<std::string> hemisphere(rows.begin(), rows.begin() + 24);
  EXPECT_EQ(refusal_of(file(gain_header, hemisphere)),
            "p.csv:18: theta_deg: expected zeniths from 0 to 180, found them from 0 to 90");
  std::vector<std::string> row_missing = rows;
  row_missing.erase(row_missing.begin() + 8, row_missing.begin() + 16);
  EXPECT_THAT(refusal_of(file(gain_header, row_missing)), HasSubstr("theta_deg: expected even steps"));
  EXPECT_EQ(refusal_of(file(gain_header, lines(flat, -90.0, 90.0))),
            "p.csv:6: phi_deg: expected azimuths once around (360 degrees), found 5 from -90 to 90");
  EXPECT_EQ(refusal_of(file(gain_header, lines(flat, 0.0, 0.0))),
            "p.csv:1: phi_deg: expected 4 azimuths or more, found 1");
  EXPECT_EQ(refusal_of(file(gain_header, {"0,0,0", "0,90,0", "0,180,0", "0,270,0", "180,0,0", "180,90,0",
                                          "180,180,0", "180,270,0"})),
            "p.csv:1: theta_deg: expected 3 zeniths or more, found 2");
  // The two copies of a meridian must have equal values.
  std::vector<std::string> seam = lines(flat, -180.0, 180.0);
  seam[17] = "45,180,4";
  EXPECT_EQ(
      refusal_of(file(gain_header, seam)),
      "p.csv:19: theta_deg 45, phi_deg 180: expected the values of phi_deg -180 (line 11), found others");
}

TEST(PatternCsv, HeadersAndEmptyFiles) {
  EXPECT_EQ(refusal_of(""), "p.csv:1: expected samples of a pattern, found none");
  EXPECT_EQ(refusal_of(std::string(gain_header) + "\n"),
            "p.csv:1: expected samples of a pattern, found none");
  EXPECT_EQ(refusal_of("phi_deg,theta_deg,gain_dbi\n"),
            fmt::format("p.csv:1:1: expected the header '{}' or '{}', found 'phi_deg,theta_deg,gain_dbi'",
                        gain_header, field_header));
  EXPECT_THAT(refusal_of("0,0,1\n"), HasSubstr("p.csv:1:1: expected the header"));
  EXPECT_EQ(refusal_of(file(gain_header, lines([](double, double) { return "-inf"; }))),
            "p.csv:1: expected a gain somewhere, found none");
}

TEST(PatternCsv, LinesThatEachHaveTheirOwnAnglesMakeNoSquareOfThem) {
  // A line for each of 30,001 zeniths, each at its own azimuth, would make a table of 900 million places.
  std::string text = std::string(gain_header) + "\n";
  for (int i = 0; i <= 30000; ++i)
    text += fmt::format("{:.6f},{:.6f},0\n", i * (180.0 / 30000.0), i * (360.0 / 30001.0));
  EXPECT_EQ(refusal_of(text), "p.csv:2: theta_deg 0, phi_deg 0.012: expected a line, found none");
}

TEST(PatternCsv, AFileThatIsNotThereIsNamed) {
  try {
    load_pattern_csv("absent.csv");
    FAIL();
  } catch (const UserError& error) {
    EXPECT_THAT(error.what(), HasSubstr("absent.csv: expected a readable file of an antenna pattern"));
  }
}

}  // namespace
}  // namespace greatx::sim
