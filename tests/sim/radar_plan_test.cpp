// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Tests which radar effects a scenario needs and why.
#include "sim/plan/radar_plan.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "sim/plan/effect_plan.h"
#include "sim/scenario/parse/load_scenario.h"
#include "tests/sim/radio_run.h"

namespace greatx::sim {
namespace {

using ::testing::HasSubstr;

/// Returns the plan of a radar at 77 GHz over a floor of this material.
EffectPlan radar_plan(scene::Material material, const std::string& more = "") {
  test::TinyScene tiny;
  const uint32_t floor = tiny.material_as(material);
  tiny.object("floor", 0, floor).quad({-30, -30, 0}, {30, -30, 0}, {30, 30, 0}, {-30, 30, 0});
  return make_effect_plan(
      parse_scenario("greatx: 1\nname: test\nticks: 1\ntick_rate_hz: 10\nnodes:\n  - name: mast\n"
                     "    trajectory: {type: static, position_m: [0, 0, 5]}\n"
                     "    sensors: [{name: radar, type: radar, rate_hz: 10}]\n" +
                         more,
                     "test.yaml", "."),
      tiny.build());
}

TEST(RadarPlan, ClutterIsOnWhereAMaterialHasAModel) {
  scene::Material concrete = testing::radio_material("concrete");
  EXPECT_FALSE(radar_plan(concrete).radar_clutter.on);
  concrete.radio->scattering_coefficient = 0.3;
  const EffectPlan scattering = radar_plan(concrete);
  EXPECT_FALSE(scattering.radar_clutter.on);
  EXPECT_THAT(scattering.radar_clutter.reason, HasSubstr("effects: {radar_clutter: on}"));
  EXPECT_TRUE(radar_plan(concrete, "effects: {radar_clutter: on}\n").radar_clutter.on);
  concrete.radio->clutter = scene::clutter_called("concrete");
  const EffectPlan clutter = radar_plan(concrete);
  EXPECT_TRUE(clutter.radar_clutter.on);
  EXPECT_THAT(clutter.radar_clutter.reason, HasSubstr("concrete is one"));
  EXPECT_FALSE(radar_plan(concrete, "effects: {radar_clutter: off}\n").radar_clutter.on);
}

TEST(RadarPlan, WavesPassWallsThatEndAndWindows) {
  scene::Material wall = testing::radio_material("concrete");
  EXPECT_FALSE(radar_plan(wall).radar_transmission.on);
  wall.radio->windows = scene::RadioWindows{0.0, {{*scene::itu_medium("glass"), 0.006}}};
  EXPECT_FALSE(radar_plan(wall).radar_transmission.on);
  wall.radio->windows->share = 0.3;
  EXPECT_TRUE(radar_plan(wall).radar_transmission.on);
  EXPECT_TRUE(radar_plan(testing::radio_material("concrete", 0.2)).radar_transmission.on);
}

TEST(RadarPlan, AirIsOnWhereItTakesMoreThanTheTolerance) {
  const scene::Material concrete = testing::radio_material("concrete");
  EXPECT_FALSE(radar_plan(concrete, "tolerance_db: 0.5\n").radar_air.on);
  const EffectPlan rain = radar_plan(concrete, "tolerance_db: 0.5\nenvironment: {rain_mm_h: 50}\n");
  EXPECT_TRUE(rain.radar_air.on);
  EXPECT_THAT(rain.radar_air.bound, HasSubstr("dB out to the range span and back"));
}

TEST(RadarPlan, AttenuationIsThatOfTheRecommendations) {
  Environment environment;
  // P.676-13 at 77 GHz, standard air (1013 hPa, 15 C, 7.5 g/m^3): 0.4 dB/km.
  EXPECT_NEAR(radar_air_db_per_km(environment, 77e9), 0.4, 0.1);
  environment.rain_mm_h = 25.0;
  // P.838-3 at 77 GHz and 25 mm/h: k = 1.1, alpha = 0.71 for both polarizations, give 10.8 dB/km.
  EXPECT_NEAR(radar_air_db_per_km(environment, 77e9), 11.2, 0.6);
  // Beyond the recommendations nothing is counted.
  EXPECT_EQ(radar_air_db_per_km(environment, 0.5e9), 0.0);
}

TEST(RadarPlan, RainSendsEchoesBackWhereItRains) {
  const scene::Material concrete = testing::radio_material("concrete");
  const EffectPlan dry = radar_plan(concrete), wet = radar_plan(concrete, "environment: {rain_mm_h: 10}\n");
  EXPECT_FALSE(dry.radar_rain.on);
  EXPECT_THAT(dry.radar_rain.reason, HasSubstr("it does not rain"));
  EXPECT_TRUE(wet.radar_rain.on);
  EXPECT_THAT(wet.radar_rain.bound, HasSubstr("dBsm/m^3 at 77 GHz"));
  EXPECT_FALSE(
      radar_plan(concrete, "environment: {rain_mm_h: 10}\neffects: {radar_rain: off}\n").radar_rain.on);
  Environment environment;
  EXPECT_EQ(radar_rain(environment, 77e9).reflectivity_per_m, 0.0);
  environment.rain_mm_h = 10.0;
  EXPECT_NEAR(10.0 * std::log10(radar_rain(environment, 77e9).reflectivity_per_m), -31.9, 0.3);
  EXPECT_EQ(radar_rain(environment, 400e9).reflectivity_per_m, 0.0);
}

TEST(RadarPlan, LeakageAndInterferenceAreOffUnlessAskedFor) {
  const EffectPlan plan = radar_plan(testing::radio_material("concrete"));
  EXPECT_FALSE(plan.radar_leakage.on || plan.radar_interference.on);
  EXPECT_THAT(plan.radar_leakage.reason, HasSubstr("no receiver has one"));
  EXPECT_THAT(plan.radar_interference.reason, HasSubstr("no radar asks for those of others"));
}

}  // namespace
}  // namespace greatx::sim
