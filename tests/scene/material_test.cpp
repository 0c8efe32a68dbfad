// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "scene/material/material.h"

#include <cmath>

#include <gtest/gtest.h>
#include <spdlog/sinks/ostream_sink.h>
#include <spdlog/spdlog.h>

#include "scene/material/conductors.h"
#include "tests/scene/gltf_writer.h"

namespace greatx::scene {
namespace {

using test::expect_user_error;

double conductivity(const std::string& name, double hertz) {
  const RadioMedium medium = *itu_medium(name);
  return -relative_permittivity(medium, hertz, name).imag() * 2.0 * 3.14159265358979323846 * hertz *
         8.8541878128e-12;
}

TEST(ItuMaterials, AgreeWithIndependentFiguresAt9GHz) {
  struct Figure {
    const char* name;
    double real, sigma, tolerance;
  };
  // values of P.2040-3, with the digits that are printed there
  for (const Figure& figure :
       {Figure{"concrete", 5.24, 0.25766, 5e-6}, Figure{"brick", 3.91, 0.033826, 5e-7},
        Figure{"glass", 6.31, 0.068299, 5e-7}, Figure{"marble", 7.074, 0.04209, 5e-6}}) {
    EXPECT_DOUBLE_EQ(relative_permittivity(*itu_medium(figure.name), 9e9, figure.name).real(), figure.real);
    EXPECT_NEAR(conductivity(figure.name, 9e9), figure.sigma, figure.tolerance) << figure.name;
  }
}

TEST(ItuMaterials, ConcreteAt3Point5GHz) {
  const auto eta = relative_permittivity(*itu_medium("concrete"), 3.5e9, "concrete");
  EXPECT_DOUBLE_EQ(eta.real(), 5.24);
  EXPECT_NEAR(eta.imag(), -0.632143, 5e-7);
}

TEST(ItuMaterials, FrequencyDependentRealPart) {
  // eta' = 30 f^-0.4 at 4 GHz, sigma = 0.15 f^1.3 (wet ground).
  EXPECT_NEAR(relative_permittivity(*itu_medium("wet_ground"), 4e9, "g").real(), 30.0 * std::pow(4.0, -0.4),
              1e-12);
  EXPECT_NEAR(conductivity("wet_ground", 4e9), 0.15 * std::pow(4.0, 1.3), 1e-12);
}

TEST(ItuMaterials, NamesIgnoreCasePrefixAndPunctuation) {
  for (const char* name : {"ceiling_board", "itu_ceiling_board", "ITU-Ceiling Board", "CeilingBoard"}) {
    ASSERT_TRUE(itu_medium(name)) << name;
    EXPECT_EQ(itu_medium(name)->source, "ITU-R P.2040-4 Table 3, ceiling_board");
  }
  EXPECT_FALSE(itu_medium("unobtanium"));
  EXPECT_FALSE(itu_medium(""));
  EXPECT_EQ(itu_names().size(), 19u);
  for (const std::string& name : itu_names()) EXPECT_TRUE(itu_medium(name)) << name;
}

TEST(ItuMaterials, NarrowestOverlappingRangeWins) {
  const RadioMedium wood = *itu_medium("wood");
  EXPECT_DOUBLE_EQ(row_at(wood, 120e9, "wood").a, 1.82);    // 110–330 rather than 100–400
  EXPECT_DOUBLE_EQ(row_at(wood, 105e9, "wood").a, 2.1183);  // only 100–400 holds
  EXPECT_DOUBLE_EQ(row_at(wood, 350e9, "wood").a, 2.1183);
  EXPECT_DOUBLE_EQ(row_at(wood, 100e9, "wood").a,
                   1.99);  // ends belong to the range; .001–100 is narrower than 300
  EXPECT_DOUBLE_EQ(row_at(*itu_medium("chipboard"), 100e9, "c").a, 2.58);  // 99 GHz wide against 100
}

/// Returns the power that a half-space reflects at normal incidence.
double reflected(std::complex<double> eta) {
  const std::complex<double> root = std::sqrt(eta);
  return std::norm((1.0 - root) / (1.0 + root));
}
constexpr double vacuum_f_m = 8.8541878128e-12, two_pi = 2.0 * 3.14159265358979323846;

TEST(Conductors, ReflectAsHagenAndRubensFound) {
  for (const std::string& name : conductor_names()) {
    const RadioMedium metal = *conductor_medium(name);
    const double sigma = metal.rows.at(0).c;
    for (const double hertz : {3.5e9, 28e9, 140e9, 300e9, 1e12}) {
      const double loss = 2.0 * std::sqrt(2.0 * two_pi * hertz * vacuum_f_m / sigma);
      const double ours = 1.0 - reflected(relative_permittivity(metal, hertz, name));
      EXPECT_NEAR(ours, loss, loss * loss) << name << ' ' << hertz;
      EXPECT_GT(ours, 0.9 * loss);
    }
    expect_user_error([&] { row_at(metal, 1.1e12, "roof"); },
                      {"roof", name, "1100 GHz", "0.001 to 1000 GHz"});
  }
  EXPECT_FALSE(conductor_medium("Copper"));
  EXPECT_FALSE(conductor_medium(""));
  EXPECT_NEAR(conductor_medium("copper")->rows[0].c, 5.813e7, 1.0);
}

TEST(Conductors, AreThoseOfDrudeWithinTheStatedError) {
  // Electrons of copper are damped at 2.2 THz (Ordal et al. 1983): sigma/(1 + j f/2.2 THz), with e^{+jwt}.
  for (const auto& [hertz, error] : {std::pair(140e9, 4e-5), std::pair(300e9, 2e-4), std::pair(1e12, 6e-4)}) {
    const std::complex<double> sigma = 5.813e7 / std::complex<double>(1.0, hertz / 2.2e12);
    const std::complex<double> eta =
        1.0 - std::complex<double>(0.0, 1.0) * sigma / (two_pi * hertz * vacuum_f_m);
    EXPECT_NEAR(reflected(relative_permittivity(*conductor_medium("copper"), hertz, "")), reflected(eta),
                error);
  }
}

TEST(ItuMaterials, MetalGoesOnTo1THz) {
  const RadioMedium metal = *itu_medium("metal");
  for (const double hertz : {50e9, 100e9, 140e9, 1e12}) EXPECT_NEAR(conductivity("metal", hertz), 1e7, 1.0);
  EXPECT_EQ(row_at(metal, 100e9, "m").max_hz, 100e9);  // the recommendation's own row as far as it goes
  expect_user_error([&] { row_at(metal, 1.5e12, "m"); }, {"1500 GHz", "1 to 100 GHz, 100 to 1000 GHz"});
  expect_user_error([&] { row_at(*itu_medium("asphalt_concrete"), 140e9, "street"); },
                    {"street", "140 GHz", "1 to 40 GHz", "beyond_range: extrapolate"});
}

TEST(HardCase, N35_FrequencyInAGapIsAnErrorOrAskedFor) {
  RadioMedium concrete = *itu_medium("concrete");
  expect_user_error([&] { row_at(concrete, 105e9, "north wall"); },
                    {"north wall", "105 GHz", "1 to 100 GHz", "110 to 330 GHz", "extrapolate"});
  expect_user_error([&] { row_at(concrete, 0.5e9, "wall"); }, {"0.5 GHz"});
  expect_user_error([&] { row_at(concrete, 400e9, "wall"); }, {"400 GHz"});
  expect_user_error([&] { row_at(concrete, -1.0, "wall"); }, {"positive"});
  concrete.extrapolate = true;
  EXPECT_DOUBLE_EQ(row_at(concrete, 0.5e9, "wall").a, 5.24);
  EXPECT_DOUBLE_EQ(row_at(concrete, 102e9, "wall").a, 5.24);
  EXPECT_DOUBLE_EQ(row_at(concrete, 109e9, "wall").a, 5.17);
  EXPECT_DOUBLE_EQ(row_at(concrete, 400e9, "wall").a, 5.17);
}

TEST(ItuMaterials, AnExtrapolationIsWarnedOfOnceByName) {
  std::ostringstream text;
  const auto before = spdlog::default_logger();
  spdlog::set_default_logger(
      std::make_shared<spdlog::logger>("", std::make_shared<spdlog::sinks::ostream_sink_mt>(text)));
  RadioMedium asphalt = *itu_medium("asphalt_concrete");
  asphalt.extrapolate = true;
  for (const double hertz : {28e9, 140e9, 150e9}) row_at(asphalt, hertz, "high street");
  row_at(asphalt, 140e9, "lane");
  const RadioMedium own{"explicit a, b, c, d", {{2.0, 0.0, 0.1, 0.0, 1e9, 2e9}}, true};
  for (const char* name : {"tent", "tent", "kiosk"}) row_at(own, 3e9, name);
  spdlog::set_default_logger(before);
  EXPECT_NE(text.str().find("beyond_range: 'high street' (ITU-R P.2040-4 Table 3, asphalt_concrete: 1 to 40 "
                            "GHz) is extrapolated to 140 GHz"),
            std::string::npos)
      << text.str();
  EXPECT_EQ(text.str().find("150 GHz"), std::string::npos);
  EXPECT_EQ(text.str().find("28 GHz"), std::string::npos);
  EXPECT_EQ(text.str().find("lane"), std::string::npos);
  const size_t tent = text.str().find("'tent' (explicit a, b, c, d: 1 to 2 GHz) is extrapolated to 3 GHz");
  ASSERT_NE(tent, std::string::npos);
  EXPECT_EQ(text.str().find("'tent'", tent + 1), std::string::npos);
  EXPECT_NE(text.str().find("'kiosk'"), std::string::npos);
}

}  // namespace
}  // namespace greatx::scene
