// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "scene/material/clutter.h"

#include <cmath>

#include <gtest/gtest.h>

#include "core/units.h"

namespace greatx::scene {
namespace {

double vv_db(const char* name, double grazing_deg, double frequency_hz) {
  return decibels(backscatter(*clutter_called(name), std::sin(radians(grazing_deg)), frequency_hz).vv);
}

TEST(Clutter, ModelsHaveTheirNumbersAtTheirReference) {
  EXPECT_NEAR(vv_db("concrete", 20.0, 10e9), -49.0, 1e-9);
  EXPECT_NEAR(vv_db("concrete", 2.0, 10e9), -81.0, 1e-9);
  EXPECT_NEAR(vv_db("concrete", 20.0, 100e9), -29.0, 1e-9);
  EXPECT_NEAR(vv_db("soil", 20.0, 100e9), -22.0, 1e-9);
  EXPECT_NEAR(vv_db("snow", 20.0, 10e9), -34.0, 1e-9);
  EXPECT_NEAR(vv_db("buildings", 20.0, 10e9), -8.5, 1e-9);
  EXPECT_NEAR(vv_db("foliage", 30.0, 10e9), -15.0 + decibels(0.5), 1e-9);
  EXPECT_NEAR(vv_db("foliage", 90.0, 100e9), -9.0, 1e-9);
}

/// The figures follow from the formula of Gregers-Hansen and Mital, evaluated by hand for sea state 1.
TEST(Clutter, WaterIsThatOfItsFormula) {
  const Backscatter at = backscatter(*clutter_called("water"), std::sin(radians(10.0)), 10e9);
  const double sine_db = std::log10(std::sin(radians(10.0)));
  EXPECT_NEAR(decibels(at.hh),
              -73.0 + 20.781 * sine_db + (27.5 + 73.51) / 10.5 + 25.65 * std::pow(2.0, 1.0 / 2.883) + 0.54,
              1e-9);
  EXPECT_NEAR(decibels(at.vv),
              -50.796 + 25.93 * sine_db + (27.5 + 7.093) / 10.5 + 21.588 * std::pow(2.0, 1.0 / 2.883) + 0.211,
              1e-9);
  EXPECT_GT(at.vv, at.hh);
}

TEST(Clutter, FallsToNothingAtGrazingIncidence) {
  for (const std::string& name : clutter_names()) {
    const SurfaceClutter clutter = *clutter_called(name);
    double before = 0.0;
    for (const double sine : {1e-9, 1e-6, 1e-3, 0.01, 0.1, 0.3}) {
      const Backscatter at = backscatter(clutter, sine, 77e9);
      EXPECT_TRUE(std::isfinite(at.hh) && at.hh > 0.0) << name;
      EXPECT_GE(at.hh, before) << name << " at " << sine;
      EXPECT_NEAR(at.hv, std::pow(10.0, 0.1 * clutter.cross_db) * 0.5 * (at.hh + at.vv), 1e-12 * at.hh);
      before = at.hh;
    }
    EXPECT_EQ(backscatter(clutter, 0.0, 77e9).hh, 0.0);
    EXPECT_EQ(backscatter(clutter, -0.5, 77e9).hh, 0.0);
  }
  EXPECT_FALSE(clutter_called("lawn"));
}

}  // namespace
}  // namespace greatx::scene
