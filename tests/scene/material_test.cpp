// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "scene/material/material.h"

#include <gtest/gtest.h>

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

}  // namespace
}  // namespace greatx::scene
