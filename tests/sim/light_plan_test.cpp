// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Tests how a scenario's environment becomes light: defaults, day and night, clouds and fog.
#include "sim/plan/light_plan.h"

#include <cmath>

#include <gtest/gtest.h>

#include "core/units.h"
#include "renderer/daylight/twilight.h"
#include "sim/scenario/date_time.h"

namespace greatx::sim {
namespace {

Environment paris(const char* time) {
  Environment e;
  e.place = PlaceAndTime{radians(48.8738), radians(2.295), 60.0, time, *parse_date_time(time)};
  return e;
}

TEST(LightPlan, ASunByHandKeepsItsDefaults) {
  const ResolvedLight light = resolve({});
  EXPECT_EQ(light.lighting.sun_illuminance_lux, 100000.0);
  EXPECT_EQ(light.lighting.sky_illuminance_lux, 15000.0);
  EXPECT_EQ(light.lighting.moon_illuminance_lux, 0.0);
  EXPECT_EQ(light.key.body, render::KeyLight::Body::sun);
  EXPECT_FALSE(light.haze);
  EXPECT_FALSE(light.night_sky);
  EXPECT_NEAR(light.ground_lux(), 100000.0 * std::sqrt(0.5) + 15000.0, 1e-6);
  Environment given;
  given.sun_illuminance_lux = 5.0;
  given.sky_illuminance_lux = 6.0;
  EXPECT_EQ(resolve(given).lighting.sun_illuminance_lux, 5.0);
  EXPECT_EQ(resolve(given).lighting.sky_illuminance_lux, 6.0);
}

TEST(LightPlan, BelowTheHorizonTheSkyIsThatOfTwilight) {
  Environment e;
  for (const double h : {-0.5, -6.0, -30.0}) {
    e.sun_elevation = radians(h);
    const ResolvedLight light = resolve(e);
    EXPECT_NEAR(light.lighting.sky_illuminance_lux / render::sunlight_lux(radians(h)), 1.0, 1e-9) << h;
    EXPECT_EQ(light.key.body, render::KeyLight::Body::none);
    EXPECT_EQ(light.night_sky, h < -6.1) << h;
  }
  e.sky_glow_cd_m2 = 0.01;
  EXPECT_NEAR(resolve(e).lighting.sky_illuminance_lux,
              render::natural_night_lux + render::night_sky_lux(0.01), 1e-9);
}

TEST(LightPlan, PlaceAndTimeGiveDayAndNight) {
  // Paris at the June solstice, close to local noon: the sun stands 64.6 degrees high in the south. The
  // earth's distance from the sun divides the published illuminance by 1.033.
  const ResolvedLight noon = resolve(paris("2026-06-21T13:53:00+02:00"));
  EXPECT_NEAR(degrees(noon.sun_elevation), 90.0 - 48.8738 + 23.43, 0.05);
  EXPECT_LT(noon.key.direction.y, -0.4);
  EXPECT_NEAR(noon.ground_lux() / render::sunlight_lux(noon.sun_elevation), 1.0 / (1.0163 * 1.0163), 3e-3);
  EXPECT_GT(noon.lighting.sun_illuminance_lux, 80000.0);
  EXPECT_GT(noon.lighting.sky_illuminance_lux, 8000.0);
  // The same place late in the evening, near the full moon of 2026-11-24: the moon is the key light.
  const ResolvedLight night = resolve(paris("2026-11-24T22:30:00+01:00"));
  EXPECT_EQ(night.key.body, render::KeyLight::Body::moon);
  EXPECT_GT(night.moon_elevation, radians(40.0));
  EXPECT_LT(night.lighting.moon_phase_angle, radians(15.0));
  EXPECT_GT(night.key.lux, 0.05);
  EXPECT_LT(night.key.lux, 0.35);
  EXPECT_TRUE(night.night_sky);
  // A fortnight later the moon is new, and neither sun nor moon is up.
  const ResolvedLight dark = resolve(paris("2026-12-09T22:30:00+01:00"));
  EXPECT_EQ(dark.key.body, render::KeyLight::Body::none);
  EXPECT_NEAR(dark.lighting.sky_illuminance_lux, render::natural_night_lux, 1e-12);
}

TEST(LightPlan, LightIsContinuousThroughSunset) {
  Environment e = paris("2026-03-20T18:30:00+01:00");
  const double start = e.place->unix_s;
  double before = 0.0, before_direct = 0.0;
  for (int step = 0; step < 60;
       ++step) {  // an hour in steps of a minute, in which the sun sinks 0.16 degrees
    e.place->unix_s = start + 60.0 * step;
    const ResolvedLight light = resolve(e);
    const double direct = light.lighting.sun_illuminance_lux;
    EXPECT_GT(light.ground_lux(), 0.0);
    if (step > 0) {
      EXPECT_NEAR(std::log10(light.ground_lux() / before), 0.0, 0.13) << step;
      EXPECT_LT(std::abs(direct - before_direct), 0.4 * before_direct + 100.0) << step;
    }
    before = light.ground_lux();
    before_direct = direct;
  }
  EXPECT_EQ(before_direct, 0.0);
}

TEST(LightPlan, AClearSkyHasFairWeatherCloudsUnlessTheScenarioSaysOtherwise) {
  Environment e;
  EXPECT_EQ(resolve(e).lighting.clouds, 0.3);
  e.clouds = 0.7;
  EXPECT_EQ(resolve(e).lighting.clouds, 0.7);
  e.sky = SkyKind::overcast;
  EXPECT_EQ(resolve(e).lighting.clouds, 0.0) << "its cover is closed";
  EXPECT_EQ(resolve(e).lighting.horizon, render::HorizonKind::automatic);
  for (const auto& [wish, kind] : {std::pair(Horizon::none, render::HorizonKind::none),
                                   std::pair(Horizon::plain, render::HorizonKind::plain),
                                   std::pair(Horizon::city, render::HorizonKind::city),
                                   std::pair(Horizon::country, render::HorizonKind::country)}) {
    e.horizon = wish;
    EXPECT_EQ(resolve(e).lighting.horizon, kind);
  }
}

TEST(LightPlan, RainBringsCloudsAndFogTakesTheShadows) {
  Environment e;
  e.rain_mm_h = 10.0;
  const ResolvedLight rain = resolve(e);
  EXPECT_EQ(rain.lighting.sky_model, render::SkyModel::overcast);
  EXPECT_EQ(rain.key.lux, 0.0);
  EXPECT_NEAR(rain.lighting.sky_illuminance_lux, 300.0 + 21000.0 * std::sqrt(0.5), 1e-6);
  e.sun_illuminance_lux = 50000.0;  // a shower while the sun shines
  EXPECT_EQ(resolve(e).lighting.sky_model, render::SkyModel::clear);
  Environment fog;
  fog.fog_g_m3 = 0.5;
  const ResolvedLight thick = resolve(fog);
  EXPECT_NEAR(thick.lighting.haze_extinction_per_m, 0.1447 * std::pow(0.5, 0.88), 1e-12);
  EXPECT_EQ(thick.lighting.haze_depth, 100.0 * thick.lighting.haze_extinction_per_m);
  EXPECT_LT(thick.below.direct_lux, 5.0);
  EXPECT_GT(thick.below.sky_lux, 30000.0);
  EXPECT_LT(thick.ground_lux(), resolve({}).ground_lux());
}

TEST(LightPlan, RainWetsTheGround) {
  Environment e;
  EXPECT_EQ(wetness_of(e), 0.0);
  EXPECT_EQ(puddles_of(e), 0.0);
  EXPECT_FALSE(resolve(e).water || resolve(e).rain || resolve(e).snow);
  e.rain_mm_h = 1.0;
  EXPECT_NEAR(wetness_of(e), 1.0 - std::exp(-1.0), 1e-12);
  EXPECT_NEAR(puddles_of(e), 0.2 * std::pow(1.0 - std::exp(-1.0), 2.0), 1e-12);
  EXPECT_TRUE(resolve(e).water && resolve(e).rain);
  EXPECT_EQ(resolve(e).lighting.rain_mm_h, 1.0);
  e.wetness = 0.0;
  EXPECT_EQ(puddles_of(e), 0.0);
  EXPECT_FALSE(resolve(e).water);
  e.puddles = 0.3;
  EXPECT_TRUE(resolve(e).water);
  EXPECT_EQ(resolve(e).lighting.puddles, 0.3);
  e.snow = 0.4;
  EXPECT_TRUE(resolve(e).snow);
}

}  // namespace
}  // namespace greatx::sim
