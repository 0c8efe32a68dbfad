// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Checks gas, rain, fog and foliage against the figures of the recommendations and against an independent
// evaluation of the recommendations in Python. Closed forms agree to much better than 0.01 dB.
#include <algorithm>
#include <cmath>
#include <limits>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/error.h"
#include "core/units.h"
#include "rf/atmosphere/bounds.h"
#include "rf/atmosphere/fog.h"
#include "rf/atmosphere/foliage.h"
#include "rf/atmosphere/gas.h"
#include "rf/atmosphere/gas_lines.h"
#include "rf/atmosphere/path_attenuation.h"
#include "rf/paths/radio_model.h"
#include "rf/surface/roughness.h"
#include "rf/surface/surfaces.h"
#include "scene/build/build.h"
#include "scene/generator/generate.h"
#include "scene/material/lossless.h"
#include "tests/rf/scenes.h"

namespace greatx::rf {
namespace {

using testing::HandScene;

constexpr Weather standard{};  // 15 C, 7.5 g/m3, 1013.25 hPa of dry air
constexpr Weather storm{.rain_mm_h = 25.0, .fog_g_m3 = 0.05};

double standard_gas(double ghz) { return gas_db_per_km(ghz * 1e9, 288.15, 1013.25, 7.5); }

template <typename Call>
std::string message_of(const Call& call) {
  try {
    call();
  } catch (const UserError& error) {
    return error.what();
  }
  return "accepted";
}

// ------------------------------------------------------------------------------------------------------- gas

TEST(Gas, StandardAir) {
  EXPECT_NEAR(standard_gas(3.5), 0.007809544, 5e-10);
  EXPECT_NEAR(standard_gas(28.0), 0.1017560, 5e-8);
  EXPECT_NEAR(standard_gas(1.0), 0.005439562785, 1e-12);
  EXPECT_NEAR(standard_gas(1000.0), 695.7721822, 1e-6);
}

TEST(Gas, ValidationExamplesOfTheRecommendation) {
  // ITU-R study group 3, validation examples CG-3M3J-13, P.676-13 Annex 1: oxygen + water vapour.
  EXPECT_NEAR(standard_gas(12.0), 0.00869826 + 0.00953539, 2e-8);
  EXPECT_NEAR(standard_gas(20.0), 0.01188355 + 0.09704730, 2e-8);
  EXPECT_NEAR(standard_gas(60.0), 14.62347480 + 0.15484184, 2e-8);
  EXPECT_NEAR(standard_gas(90.0), 0.03886971 + 0.34197339, 2e-8);
  EXPECT_NEAR(standard_gas(130.0), 0.04150908 + 0.75184470, 2e-8);
}

TEST(Gas, OtherTemperaturesAndPressures) {
  EXPECT_NEAR(gas_db_per_km(28e9, 263.15, 700.0, 2.0), 0.02967284545, 1e-11);
  EXPECT_NEAR(gas_db_per_km(140e9, 313.15, 900.0, 40.0), 5.538180397571518, 1e-11);
  EXPECT_NEAR(gas_db_per_km(118.750334e9, 220.0, 10.0, 0.0), 2.401629571, 1e-9);
}

TEST(Gas, HumidityMatters) {
  const double dry = gas_db_per_km(140e9, 288.15, 1013.25, 0.0);
  EXPECT_NEAR(dry, 0.01886, 5e-6);
  EXPECT_NEAR(standard_gas(140.0) / dry, 50.0, 2.0);
  double before = 0.0;
  for (const double vapour : {0.0, 1.0, 7.5, 20.0, 40.0}) {
    const double here = gas_db_per_km(28e9, 288.15, 1013.25, vapour);
    EXPECT_GT(here, before);
    before = here;
  }
}

TEST(Gas, LineTablesAreWhole) {
  ASSERT_EQ(oxygen_lines().size(), 44u);
  ASSERT_EQ(water_vapour_lines().size(), 35u);
  for (size_t i = 1; i < 44; ++i) EXPECT_GT(oxygen_lines()[i].f0_ghz, oxygen_lines()[i - 1].f0_ghz);
  for (size_t i = 1; i < 35; ++i)
    EXPECT_GT(water_vapour_lines()[i].f0_ghz, water_vapour_lines()[i - 1].f0_ghz);
}

TEST(Gas, PeaksAtLineCentresAreFinite) {
  EXPECT_NEAR(standard_gas(60.306056), 15.02534182, 1e-8);
  EXPECT_NEAR(standard_gas(118.750334), 1.948930292, 1e-9);
  EXPECT_NEAR(standard_gas(183.310087), 28.0204933, 1e-7);
  EXPECT_NEAR(standard_gas(556.935985), 17109.48578, 1e-5);
  // At low pressure the lines are narrow: at 1 hPa the attenuation at the centre exceeds that 50 MHz beside
  // it.
  const double centre = gas_db_per_km(118.750334e9, 250.0, 1.0, 0.0);
  EXPECT_GT(centre, 100.0 * gas_db_per_km(118.800334e9, 250.0, 1.0, 0.0));
  for (const OxygenLine& line : oxygen_lines())
    EXPECT_TRUE(std::isfinite(gas_db_per_km(line.f0_ghz * 1e9, 220.0, 0.0, 0.0)));
  for (const WaterVapourLine& line : water_vapour_lines())
    if (line.f0_ghz <= 1000.0) {
      EXPECT_GT(standard_gas(line.f0_ghz), 0.0);
      EXPECT_TRUE(std::isfinite(gas_db_per_km(line.f0_ghz * 1e9, 220.0, 0.0, 0.0)));
    }
}

TEST(Gas, NothingInAVacuumAndNeverAGain) {
  EXPECT_EQ(gas_db_per_km(28e9, 288.15, 0.0, 0.0), 0.0);
  for (double ghz = 1.0; ghz <= 1000.0; ghz *= 1.003) {
    EXPECT_GT(standard_gas(ghz), 0.0) << ghz;
    EXPECT_GT(gas_db_per_km(ghz * 1e9, 230.0, 300.0, 0.0), 0.0) << ghz;
  }
}

TEST(Gas, OutsideItsRangeIsAnErrorThatNamesIt) {
  EXPECT_NO_THROW(standard_gas(1.0));
  EXPECT_NO_THROW(standard_gas(1000.0));
  EXPECT_EQ(
      message_of([] { standard_gas(0.9); }),
      "gas attenuation: expected a frequency from 1 to 1000 GHz (ITU-R P.676-13, Annex 1), found 0.9 GHz");
  EXPECT_THROW(standard_gas(1000.1), UserError);
  EXPECT_THROW(standard_gas(std::numeric_limits<double>::quiet_NaN()), UserError);
}

// ------------------------------------------------------------------------------------------------------ rain

TEST(Rain, PublishedTable) {
  // P.838-3, Table 5, as printed: k_H, alpha_H, k_V, alpha_V at f GHz.
  constexpr struct {
    double ghz, k_h, alpha_h, k_v, alpha_v, rounding;
  } rows[] = {
      {1, 0.0000259, 0.9691, 0.0000308, 0.8592, 5e-8}, {2, 0.0000847, 1.0664, 0.0000998, 0.9490, 5e-8},
      {4, 0.0001071, 1.6009, 0.0002461, 1.2476, 5e-8}, {8, 0.004115, 1.3905, 0.003450, 1.3797, 5e-7},
      {10, 0.01217, 1.2571, 0.01129, 1.2156, 5e-6},    {20, 0.09164, 1.0568, 0.09611, 0.9847, 5e-6},
      {30, 0.2403, 0.9485, 0.2291, 0.9129, 5e-5},      {40, 0.4431, 0.8673, 0.4274, 0.8421, 5e-5},
      {60, 0.8606, 0.7656, 0.8515, 0.7486, 5e-5},      {100, 1.3671, 0.6815, 1.3680, 0.6765, 5e-5},
      {200, 1.6378, 0.6382, 1.6443, 0.6343, 5e-5},     {400, 1.5860, 0.6262, 1.5820, 0.6256, 5e-5},
      {1000, 1.3795, 0.6396, 1.3822, 0.6365, 5e-5}};
  for (const auto& row : rows) {
    const RainCoefficients c = rain_coefficients(row.ghz * 1e9);
    EXPECT_NEAR(c.k_h, row.k_h, row.rounding) << row.ghz;
    EXPECT_NEAR(c.k_v, row.k_v, row.rounding) << row.ghz;
    EXPECT_NEAR(c.alpha_h, row.alpha_h, 1.1e-4) << row.ghz;
    EXPECT_NEAR(c.alpha_v, row.alpha_v, 1.1e-4) << row.ghz;
  }
}

/// Returns the specific attenuation by P.838-3, eq. 1, 4 and 5, dB/km, of a path at any elevation above the
/// horizon with any tilt of the polarization from the horizontal, both in rad. A tilt of pi/4 also stands for
/// circular polarization.
double tilted_rain_db_per_km(const RainCoefficients& c, double rain_mm_h, double elevation, double tilt) {
  const double lean = std::cos(elevation) * std::cos(elevation) * std::cos(2.0 * tilt);
  const double k = 0.5 * (c.k_h + c.k_v + (c.k_h - c.k_v) * lean);
  const double alpha =
      (c.k_h * c.alpha_h + c.k_v * c.alpha_v + (c.k_h * c.alpha_h - c.k_v * c.alpha_v) * lean) / (2.0 * k);
  return k * std::pow(rain_mm_h, alpha);
}

TEST(Rain, At28GHz) {
  const RainCoefficients c = rain_coefficients(28e9);
  EXPECT_NEAR(tilted_rain_db_per_km(c, 25.0, 0.0, 0.0), 4.6236, 5e-5);
  EXPECT_NEAR(tilted_rain_db_per_km(c, 25.0, 0.0, pi / 2), 3.8911, 5e-5);
  EXPECT_NEAR(tilted_rain_db_per_km(c, 25.0, radians(30), radians(45)), 4.24844857, 1e-8);
  EXPECT_NEAR(tilted_rain_db_per_km(c, 25.0, radians(30), 0.0), 4.52814094, 1e-8);
  EXPECT_NEAR(tilted_rain_db_per_km(c, 25.0, radians(30), pi / 2), 3.97875318, 1e-8);
  EXPECT_NEAR(tilted_rain_db_per_km(rain_coefficients(60e9), 5.0, radians(12), radians(70)), 2.85526107,
              1e-8);
}

TEST(Rain, PolarizationsOfADirection) {
  const RainCoefficients c = rain_coefficients(28e9);
  for (const double elevation : {0.0, 0.3, 1.0, pi / 2}) {
    const double level = std::cos(elevation) * std::cos(elevation);
    const RainAttenuation pair = rain_db_per_km(c, 25.0, level);
    EXPECT_NEAR(pair.h, tilted_rain_db_per_km(c, 25.0, elevation, 0.0), 1e-14);
    EXPECT_NEAR(pair.v, tilted_rain_db_per_km(c, 25.0, elevation, pi / 2), 1e-14);
  }
  const RainAttenuation up = rain_db_per_km(c, 25.0, 0.0);
  EXPECT_EQ(up.h, up.v);
}

TEST(Rain, NoneAndOutsideItsRange) {
  const RainAttenuation none = rain_db_per_km(rain_coefficients(28e9), 0.0, 0.99);
  EXPECT_EQ(none.h, 0.0);
  EXPECT_EQ(none.v, 0.0);
  EXPECT_THROW(rain_coefficients(0.99e9), UserError);
  EXPECT_THROW(rain_coefficients(1001e9), UserError);
  EXPECT_THAT(message_of([] { rain_coefficients(0.7e9); }), ::testing::HasSubstr("1 to 1000 GHz"));
}

// ------------------------------------------------------------------------------------------------------- fog

TEST(Fog, Coefficient) {
  EXPECT_NEAR(fog_coefficient(28e9, 288.15), 0.459530, 5e-7);
  EXPECT_NEAR(fog_coefficient(1e9, 273.15), 0.00093494005, 1e-12);
  EXPECT_NEAR(fog_coefficient(10e9, 273.15), 0.0925503823, 1e-10);
  EXPECT_NEAR(fog_coefficient(94e9, 273.15), 4.54645259, 1e-8);
  EXPECT_NEAR(fog_coefficient(200e9, 293.15), 10.4664724, 1e-7);
  EXPECT_NEAR(fog_coefficient(28e9, 265.15), 0.847131279, 1e-9);
  EXPECT_NEAR(fog_db_per_km(28e9, 288.15, 0.5), 0.5 * 0.459530, 5e-7);
}

TEST(Fog, NoneAndOutsideItsRange) {
  EXPECT_EQ(fog_db_per_km(300e9, 288.15, 0.0), 0.0);
  EXPECT_THROW(fog_db_per_km(200.1e9, 288.15, 0.05), UserError);
  EXPECT_THAT(message_of([] { fog_coefficient(300e9, 288.15); }), ::testing::HasSubstr("200 GHz"));
}

// ---------------------------------------------------------------------------------------------- along a path

TEST(PathAttenuation, AmplitudeOfDecibels) {
  for (const double gamma : {1e-6, 0.0078, 4.6, 17109.0})
    EXPECT_NEAR(20.0 * std::log10(amplitude(gamma, 10.0)), -gamma * 0.01, 1e-13 * (1.0 + gamma));
  EXPECT_EQ(amplitude(0.0, 1e12), 1.0);
  EXPECT_EQ(amplitude(4.6, 0.0), 1.0);
  // Huge distances underflow to zero without an error.
  EXPECT_EQ(amplitude(17109.0, 1e9), 0.0);
  EXPECT_EQ(amplitude(1e300, 1e300), 0.0);
  EXPECT_THROW(amplitude(-1.0, 1.0), ContractError);
  EXPECT_THROW(amplitude(1.0, std::numeric_limits<double>::infinity()), ContractError);
}

TEST(PathAttenuation, SumsWhatIsOn) {
  const PathAttenuation all = path_attenuation(storm, 28e9);
  EXPECT_NEAR(all.gas, 0.1017560, 5e-8);
  EXPECT_NEAR(all.rain_h, 4.6236, 5e-5);
  EXPECT_NEAR(all.rain_v, 3.8911, 5e-5);
  EXPECT_NEAR(all.fog, 0.05 * 0.459530, 5e-8);
  const PolarizedAmplitude level = all.of({0.6, 0.8, 0.0}, 1000.0);
  EXPECT_NEAR(20.0 * std::log10(level.theta), -(all.gas + all.fog + all.rain_v), 1e-12);
  EXPECT_NEAR(20.0 * std::log10(level.phi), -(all.gas + all.fog + all.rain_h), 1e-12);

  const PathAttenuation gas = path_attenuation(storm, 28e9, {.gas = true, .rain = false, .fog = false});
  EXPECT_EQ(gas.fog + gas.rain_h + gas.rain_v, 0.0);
  EXPECT_EQ(gas.of({1, 0, 0}, 500.0).theta, amplitude(gas.gas, 500.0));
  EXPECT_EQ(gas.of({1, 0, 0}, 500.0).phi, gas.of({1, 0, 0}, 500.0).theta);
  EXPECT_TRUE(path_attenuation(storm, 28e9, {false, false, false}).none());
  EXPECT_FALSE(all.none() || gas.none());
}

TEST(PathAttenuation, WhatIsOffOrZeroHasNoRange) {
  constexpr Weather still{};
  EXPECT_TRUE(path_attenuation(still, 0.4e9, {.gas = false, .rain = true, .fog = true}).none());
  EXPECT_TRUE(path_attenuation(still, 300e9, {.gas = false}).none());
  EXPECT_THROW(path_attenuation(still, 0.4e9), UserError);
  EXPECT_THROW(path_attenuation(storm, 0.4e9, {.gas = false}), UserError);
  EXPECT_THROW(path_attenuation(storm, 300e9), UserError);
}

TEST(PathAttenuation, RainSeparatesThePolarizationsOfEachDirection) {
  const PathAttenuation rain = path_attenuation(storm, 28e9, {.gas = false, .rain = true, .fog = false});
  for (const double elevation : {0.0, 0.4, 1.2, pi / 2}) {
    const dvec3 k(0.8 * std::cos(elevation), -0.6 * std::cos(elevation), std::sin(elevation));
    const dvec3 theta = theta_hat(k), phi = phi_hat(k);
    FieldVector field;
    field.add({0.3, -0.7}, theta);
    field.add({-0.2, 0.5}, phi);
    const FieldVector after = rain.after(field, k, 700.0);
    const Complex along_theta = after.along(theta) / Complex(0.3, -0.7),
                  along_phi = after.along(phi) / Complex(-0.2, 0.5);
    EXPECT_NEAR(20.0 * std::log10(std::abs(along_theta)),
                -0.7 * tilted_rain_db_per_km(rain.rain, 25.0, elevation, pi / 2), 1e-10);
    EXPECT_NEAR(20.0 * std::log10(std::abs(along_phi)),
                -0.7 * tilted_rain_db_per_km(rain.rain, 25.0, elevation, 0.0), 1e-10);
    EXPECT_NEAR(along_theta.imag(), 0.0, 1e-15);
    EXPECT_NEAR(std::abs(after.along(k)), 0.0, 1e-15);
  }
  // Two stretches give the same result as one.
  const dvec3 k = glm::normalize(dvec3(1, 2, 0.5));
  FieldVector field;
  field.add(1.0, glm::normalize(theta_hat(k) + phi_hat(k)));
  const FieldVector once = rain.after(field, k, 300.0),
                    twice = rain.after(rain.after(field, k, 100.0), k, 200.0);
  EXPECT_NEAR(glm::length(once.re - twice.re), 0.0, 1e-15);
}

TEST(Bounds, AreTheMostThatCanBe) {
  EXPECT_NEAR(most_gas_db(standard, 3.5e9, 800.0), 0.006247634837, 1e-11);
  EXPECT_NEAR(most_fog_db(storm, 28e9, 2000.0), 2.0 * 0.05 * 0.459530, 1e-7);
  EXPECT_EQ(most_rain_db(standard, 0.1e9, 1e6), 0.0);
  for (const double ghz : {1.0, 2.0, 5.0, 28.0, 140.0, 900.0}) {
    const double bound = most_rain_db(storm, ghz * 1e9, 1000.0);
    const RainCoefficients c = rain_coefficients(ghz * 1e9);
    double most = 0.0;
    for (int i = 0; i <= 90; i += 3)
      for (int j = 0; j <= 180; j += 3)
        most = std::max(most, tilted_rain_db_per_km(c, storm.rain_mm_h, radians(i), radians(j)));
    EXPECT_LE(most, bound * (1.0 + 1e-15)) << ghz;
    EXPECT_GE(most, bound * (1.0 - 1e-15)) << ghz;
  }
}

// --------------------------------------------------------------------------------------------------- foliage

TEST(Foliage, Weissberger) {
  const scene::Foliage model;
  EXPECT_EQ(foliage_db(model, 3.5e9, 0.0), 0.0);
  EXPECT_NEAR(foliage_db(model, 3.5e9, 1.0), 0.642285087, 1e-9);
  EXPECT_NEAR(foliage_db(model, 28e9, 10.0), 11.5932552, 1e-7);
  EXPECT_NEAR(foliage_db(model, 28e9, 100.0), 51.3859656, 1e-7);
  EXPECT_NEAR(foliage_db(model, 3.5e9, 400.0), 64.3247698, 1e-7);
  EXPECT_NEAR(foliage_db(model, 28e9, 1000.0), 198.99608, 1e-5);  // the formula continues past 400 m
  EXPECT_NEAR(foliage_db(model, 1e9, 10.0), 4.5, 1e-14);
}

TEST(Foliage, BranchesDoNotMeet) {
  const double below = foliage_db({}, 28e9, weissberger_branch_m),
               above = foliage_db({}, 28e9, std::nextafter(weissberger_branch_m, 15.0));
  EXPECT_NEAR(below, 16.2305572, 1e-7);
  EXPECT_NEAR(above, 16.1721518, 1e-6);
  EXPECT_NEAR((below - above) / std::pow(28.0, 0.284), 0.0227, 5e-5);
}

TEST(Foliage, ExplicitHoldsEverywhere) {
  const scene::Foliage explicit_loss{.attenuation_db_per_m = 0.8};
  for (const double hertz : {1e6, 28e9, 1e12}) EXPECT_DOUBLE_EQ(foliage_db(explicit_loss, hertz, 12.5), 10.0);
  EXPECT_EQ(foliage_db({.attenuation_db_per_m = 0.0}, 28e9, 50.0), 0.0);
}

TEST(Foliage, OutsideItsRange) {
  EXPECT_NO_THROW(foliage_db({}, 0.23e9, 1.0));
  EXPECT_NO_THROW(foliage_db({}, 95e9, 1.0));
  EXPECT_THAT(
      message_of([] { foliage_db({}, 0.2e9, 1.0); }),
      ::testing::AllOf(::testing::HasSubstr("0.23 to 95 GHz"), ::testing::HasSubstr("found 0.2 GHz")));
  EXPECT_THROW(foliage_db({}, 140e9, 1.0), UserError);
  EXPECT_THROW(foliage_db({}, 28e9, -1.0), ContractError);
}

/// Adds a tetrahedron with a corner at `p`, as the first `faces` of its four faces. The faces point outwards,
/// except the last one if `turn_last` is set.
void add_crown(HandScene& hand, uint32_t material, const dvec3& p, int faces = 4, bool turn_last = false) {
  const dvec3 x = p + dvec3(3, 0, 0), y = p + dvec3(0, 3, 0), z = p + dvec3(0, 0, 3);
  const dvec3 corners[4][3] = {{p, y, x}, {p, x, z}, {p, z, y}, {x, y, z}};
  for (int i = 0; i < faces; ++i) {
    const auto& c = corners[i];
    const bool turned = turn_last && i == 3;
    hand.triangle(c[0], turned ? c[2] : c[1], turned ? c[1] : c[2], material);
  }
}

HandScene with_foliage(const scene::Foliage& foliage) {
  HandScene hand;
  hand.ground(10.0, 0.0, hand.material("soil", 4.0, 0.01));
  const uint32_t leaves = hand.material("leaves", 1.0);
  hand.scene.materials[leaves].radio->layers.clear();
  hand.scene.materials[leaves].radio->foliage = foliage;
  return hand;
}

TEST(Foliage, MeshesAreClosed) {
  HandScene hand = with_foliage({});
  check_foliage(hand.scene, 28e9);  // no foliage yet
  add_crown(hand, 1, {1.1, 2.2, 3.3});
  add_crown(hand, 1, {1.6, 2.7, 3.8});  // overlaps the first
  add_crown(hand, 1, {1.1, 2.2, 3.3});  // a second time in the same place
  EXPECT_NO_THROW(check_foliage(hand.scene, 28e9));
  add_crown(hand, 1, {-7.0, 0.0, 1.0}, 3);
  hand.scene.name = "wood";
  hand.scene.instances.push_back({.name = "oak", .semantic_class = {}, .body = 0, .bounds = {}});
  EXPECT_EQ(message_of([&] { check_foliage(hand.scene, 28e9); }),
            "scene 'wood', object 'oak': expected a closed mesh of foliage 'leaves' (its depth needs an "
            "inside), found 3 "
            "open edges");
}

TEST(Foliage, GeneratedCrownsAreClosedWhereTheyStand) {
  for (const char* kind : {"city", "country"}) {
    const scene::Model model =
        scene::load_model(kind, scene::generate_glb({.kind = kind, .seed = 7, .size_m = 300}), {});
    scene::Scene built = scene::build_scene(
        {{.name = "", .model = &model, .pose = {.position = dvec3(690000, 5e6, 500)}}}, {.name = kind});
    EXPECT_NO_THROW(check_foliage(built, 3.5e9)) << kind;
    // Removes the first triangle of a crown, which the check finds.
    for (scene::Facet& facet : built.facets)
      if (built.materials[facet.material].radio->foliage && !is_lossless(built.materials[facet.material])) {
        facet.triangle_count = 0;
        break;
      }
    EXPECT_THROW(check_foliage(built, 3.5e9), UserError) << kind;
  }
}

TEST(Foliage, LeavesWithoutLossesNeedNoInside) {
  HandScene hand = with_foliage({.attenuation_db_per_m = 0.0});
  add_crown(hand, 1, {0, 0, 1}, 3);  // open
  EXPECT_NO_THROW(check_foliage(hand.scene, 28e9));
  const FacetKinds kinds = facet_kinds(hand.scene, {});
  ASSERT_EQ(kinds.size(), hand.scene.facets.size());
  size_t leaves = 0;
  for (size_t i = 0; i < kinds.size(); ++i) {
    const bool leaf = hand.scene.facets[i].material == 1;
    leaves += leaf ? 1 : 0;
    EXPECT_EQ(kinds[i] == FacetKind::absent, leaf) << i;
  }
  EXPECT_EQ(leaves, 3u);
  // A loss of any size makes them a volume again.
  HandScene lossy = with_foliage({.attenuation_db_per_m = 1e-9});
  add_crown(lossy, 1, {0, 0, 1}, 3);
  EXPECT_THROW(check_foliage(lossy.scene, 28e9), UserError);
}

TEST(Foliage, AFaceTurnedOverIsNoClosedMesh) {
  HandScene hand = with_foliage({});
  add_crown(hand, 1, {0, 0, 1}, 4, true);
  EXPECT_THROW(check_foliage(hand.scene, 28e9), UserError);
}

TEST(Foliage, FrequencyIsCheckedByMaterial) {
  HandScene hand = with_foliage({});
  add_crown(hand, 1, {0, 0, 1});
  EXPECT_THAT(message_of([&] { check_foliage(hand.scene, 140e9); }),
              ::testing::HasSubstr("material 'leaves'"));
  HandScene own = with_foliage({.attenuation_db_per_m = 2.0});
  add_crown(own, 1, {0, 0, 1});
  EXPECT_NO_THROW(check_foliage(own.scene, 140e9));
}

TEST(Foliage, HasNoSurface) {
  HandScene hand = with_foliage({});
  add_crown(hand, 1, {0, 0, 1});
  const RadioSurfaces surfaces(hand.scene, 28e9);
  EXPECT_TRUE(surfaces.surface(1).foliage);
  EXPECT_TRUE(surfaces.surface(1).front.empty());
  EXPECT_FALSE(surfaces.surface(0).foliage);
  EXPECT_THROW(surfaces.reflect(1, true, 0.5), ContractError);
}

}  // namespace
}  // namespace greatx::rf
