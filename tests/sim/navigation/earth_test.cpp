// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Pressure and magnetic field, compared with published values.
#include <cmath>

#include <gtest/gtest.h>

#include "core/error.h"
#include "core/units.h"
#include "sim/navigation/atmosphere.h"
#include "sim/navigation/magnetic_field.h"

namespace greatx::navigation {
namespace {

TEST(AirPressure, IsThatOfTheTablesOfTheStandardAtmosphere) {
  // U.S. Standard Atmosphere 1976, table I: geometric heights, in Pa, with five digits.
  const struct {
    double height_m, pressure_pa;
  } rows[] = {{0.0, 101325.0},    {1000.0, 89876.3},  {2000.0, 79501.4}, {5000.0, 54048.3},
              {10000.0, 26499.9}, {15000.0, 12111.8}, {20000.0, 5529.3}, {30000.0, 1197.0}};
  for (const auto& row : rows)
    EXPECT_NEAR(air_pressure(row.height_m) / row.pressure_pa, 1.0, 5e-5) << row.height_m;
  EXPECT_NEAR(air_pressure(0.0, 99000.0), 99000.0, 1e-9);
  // 12.01 Pa a metre at the sea.
  EXPECT_NEAR(air_pressure(0.0) - air_pressure(1.0), 12.013, 0.002);
  EXPECT_THROW(air_pressure(40000.0), UserError);
  EXPECT_THROW(air_pressure(-6000.0), UserError);
}

TEST(AirPressure, HasAnInverse) {
  for (const double height_m : {-400.0, 0.0, 123.4, 8848.0, 11000.0, 12000.0, 19000.0, 25000.0})
    for (const double sea_pa : {101325.0, 98000.0})
      EXPECT_NEAR(pressure_height(air_pressure(height_m, sea_pa), sea_pa), height_m, 1e-6);
}

TEST(Barometer, HasItsNoiseAndTheSameBiasForASequence) {
  Barometer barometer({.noise_std = 3.0, .bias_std = 25.0, .drift_std = 0.0, .resolution = 0.0}, 9, "b", 0,
                      0.1);
  double sum = 0.0, squares = 0.0;
  constexpr int count = 20000;
  const double bias = barometer.measure(0.0, 0).bias_pa;
  for (int i = 0; i < count; ++i) {
    const Barometer::Sample sample = barometer.measure(90000.0, i);
    ASSERT_EQ(sample.bias_pa, bias);
    const double noise = sample.measured_pa - 90000.0 - bias;
    sum += noise, squares += noise * noise;
  }
  EXPECT_NEAR(sum / count, 0.0, 0.07);
  EXPECT_NEAR(std::sqrt(squares / count), 3.0, 0.06);
  Barometer coarse({.noise_std = 0.0, .bias_std = 0.0, .drift_std = 0.0, .resolution = 10.0}, 9, "b", 0, 0.1);
  EXPECT_EQ(coarse.measure(90004.0, 0).measured_pa, 90000.0);
}

/// Returns declination and inclination in degrees, and the strength in nT.
dvec3 compass(const Geodetic& place, double year) {
  const dvec3 b = magnetic_field(place, year);
  return {degrees(std::atan2(b.x, b.y)), degrees(std::atan2(-b.z, std::hypot(b.x, b.y))),
          1e9 * glm::length(b)};
}

TEST(MagneticField, IsThatOfKnownPlaces) {
  // Values of calculators of IGRF-13 and WMM2020 for 2020.0 at height 0, rounded: declination (degrees east),
  // inclination (degrees down), strength (nT). The bounds are those of the degrees that are left out.
  const struct {
    const char* name;
    Geodetic place;
    double declination, inclination, strength;
  } rows[] = {{"London", {51.5, -0.13, 0.0}, -0.3, 66.4, 48900.0},
              {"Boulder", {40.0, -105.25, 0.0}, 8.3, 66.2, 52000.0},
              {"Sydney", {-33.87, 151.21, 0.0}, 12.6, -64.3, 57100.0},
              {"Singapore", {1.35, 103.82, 0.0}, 0.2, -14.2, 42200.0},
              {"Sao Paulo", {-23.55, -46.63, 0.0}, -21.6, -39.2, 22800.0}};
  for (const auto& row : rows) {
    const dvec3 found = compass(row.place, 2020.0);
    EXPECT_NEAR(found.x, row.declination, 0.7) << row.name;
    EXPECT_NEAR(found.y, row.inclination, 0.7) << row.name;
    EXPECT_NEAR(found.z, row.strength, 400.0) << row.name;
  }
}

TEST(MagneticField, IsADipoleFarAway) {
  // At 20 Earth radii the terms of degree 2 are below 1 %: B_r = 2 m . r, with m from degree 1.
  const Geodetic far{90.0, 0.0, 19.0 * 6371200.0};
  const double ratio = 6371200.0 / (6356752.314 + far.height_m);
  EXPECT_NEAR(1e9 * magnetic_field(far, 2020.0).z / (2.0 * -29404.8 * std::pow(ratio, 3)), 1.0, 0.01);
}

TEST(MagneticField, IsTheGradientOfAPotential) {
  // A field of the core has neither sources nor curl: differences of the field over small steps.
  const Geodetic place{47.0, 8.0, 500.0};
  const LocalFrame frame({place, 0.0, ""});
  // In the axes of `place` at a point beside it.
  const auto field_at = [&](const dvec3& local) {
    const Geodetic there = frame.place(local);
    const LocalFrame its({there, 0.0, ""});
    const dvec3 b = magnetic_field(there, 2025.0);
    return (frame.local(its.place(1000.0 * glm::normalize(b))) - local) * (glm::length(b) / 1000.0);
  };
  constexpr double h = 2000.0;
  dmat3 jacobian;
  for (int axis = 0; axis < 3; ++axis) {
    dvec3 step(0.0);
    step[axis] = h;
    jacobian[axis] = (field_at(step) - field_at(-step)) / (2.0 * h);
  }
  const double size = glm::length(jacobian[0]) + glm::length(jacobian[1]) + glm::length(jacobian[2]);
  EXPECT_LT(std::abs(jacobian[0][0] + jacobian[1][1] + jacobian[2][2]), 1e-5 * size);
  EXPECT_LT(std::abs(jacobian[0][1] - jacobian[1][0]), 1e-5 * size);
  EXPECT_LT(std::abs(jacobian[0][2] - jacobian[2][0]), 1e-5 * size);
  EXPECT_LT(std::abs(jacobian[1][2] - jacobian[2][1]), 1e-5 * size);
}

TEST(MagneticField, ChangesWithTheYearsOfTheModelAndIsFiniteAtThePoles) {
  const Geodetic place{48.0, 2.0, 0.0};
  EXPECT_NE(magnetic_field(place, 2020.0), magnetic_field(place, 2025.0));
  EXPECT_EQ(magnetic_field(place, 1990.0), magnetic_field(place, 2020.0));
  EXPECT_EQ(magnetic_field(place, 2099.0), magnetic_field(place, 2030.0));
  for (const double latitude : {-90.0, 90.0}) {
    const dvec3 at = magnetic_field({latitude, 0.0, 0.0}, 2020.0),
                near = magnetic_field({latitude * (1.0 - 1e-9), 0.0, 0.0}, 2020.0);
    EXPECT_NEAR(glm::length(at - near) / glm::length(at), 0.0, 1e-6);
  }
  EXPECT_NEAR(year_of(1577836800.0), 2020.0, 0.003);
}

}  // namespace
}  // namespace greatx::navigation
