// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Checks the radiance of the sky at all elevations of the sun: the exact illuminance of level ground, and
// published colours and levels.
#include "renderer/light/sky.h"

#include <cmath>

#include <gtest/gtest.h>

#include "core/units.h"
#include "renderer/daylight/atmosphere.h"
#include "renderer/daylight/twilight.h"

namespace greatx::test {
namespace {

using render::Lighting;

Lighting sun_at(double elevation_deg, double azimuth = 0.3) {
  Lighting lighting;
  lighting.sun_direction = Lighting::direction(azimuth, radians(elevation_deg));
  return lighting;
}

/// Calls visit(direction, solid angle) over the upper hemisphere.
template <typename F>
void over_sky(F&& visit) {
  constexpr int rings = 200, sectors = 120;
  for (int i = 0; i < rings; ++i)
    for (int k = 0; k < sectors; ++k) {
      const double z = (i + 0.5) / rings, phi = 2.0 * pi * (k + 0.5) / sectors, r = std::sqrt(1.0 - z * z);
      visit(dvec3(r * std::cos(phi), r * std::sin(phi), z), 2.0 * pi / (rings * sectors));
    }
}

double level_lux(const render::Sky& sky) {
  double sum = 0.0;
  over_sky([&](const dvec3& d, double solid_angle) {
    const dvec3 radiance = sky.radiance(d);
    EXPECT_TRUE(radiance.x >= 0.0 && radiance.y >= 0.0 && radiance.z >= 0.0);
    sum += render::luminance(radiance) * d.z * solid_angle;
  });
  return sum;
}

/// Returns the CIE 1931 chromaticity of a displayed colour, without the white balance.
dvec2 chromaticity(const dvec3& shown) {
  const dvec3 c = shown * render::daylight_white;
  const dvec3 xyz(glm::dot(c, dvec3(0.4124, 0.3576, 0.1805)), glm::dot(c, dvec3(0.2126, 0.7152, 0.0722)),
                  glm::dot(c, dvec3(0.0193, 0.1192, 0.9505)));
  return dvec2(xyz) / (xyz.x + xyz.y + xyz.z);
}

TEST(Sky, LightsLevelGroundAsAsked) {
  for (const double elevation : {-40.0, -15.0, -5.0, -0.5, 3.0, 30.0, 90.0})
    for (const bool moon : {false, true}) {
      Lighting lighting = sun_at(elevation);
      lighting.sky_illuminance_lux = 12345.0;
      if (moon) {
        lighting.moon_direction = Lighting::direction(-2.0, radians(35.0));
        lighting.moon_illuminance_lux = 0.2;
      }
      const render::Sky sky(lighting, false);
      EXPECT_NEAR(level_lux(sky) / 12345.0, 1.0, 3e-3) << elevation;
      EXPECT_EQ(sky.illuminance(), 12345.0);
      const double key = elevation > 0.0 ? 100000.0 : moon ? 0.2 : 0.0;
      EXPECT_NEAR(render::luminance(sky.key_illuminance()), key, 1e-9 * (1.0 + key));
      const auto sh = render::sky_irradiance(sky);
      EXPECT_NEAR(render::luminance(sh[0] + sh[2] + 2.0 * sh[6]) * pi, 12345.0, 1e-6);
    }
}

TEST(Sky, ModelOfTheAirAgreesWithMeasuredLevels) {
  // The model of the air is not fitted to the figures of the circular. A sun of 133 100 lux above the air
  // gives level ground 0.9 to 1.3 times these figures by day, and 0.9 to 1.6 times down to 10 degrees below
  // the horizon.
  for (const double h : {90.0, 60.0, 45.0, 30.0, 20.0, 10.0, 5.0, 2.0, 0.0, -2.0, -4.0, -6.0, -8.0, -10.0}) {
    const render::Atmosphere air(2.0, radians(h), 0.15);
    const double lux =
        133.1e3 * (render::luminance(air.sky_illuminance()) +
                   std::max(0.0, std::sin(radians(h))) * render::luminance(air.direct_illuminance()));
    const double ratio = lux / render::sunlight_lux(radians(h));
    EXPECT_GT(ratio, 0.9) << h;
    EXPECT_LT(ratio, h >= 0.0 ? 1.3 : 1.6) << h;
  }
}

TEST(Sky, ClearDayHasAClearDaysLuminancesAndColours) {
  // With the sun at 48 degrees and 16 000 lux of sky, the zenith has 2 to 4 thousand cd/m^2 and a colour
  // temperature of at least 10 000 K (x below 0.28). The horizon is two to four times as bright and nearly
  // white.
  Lighting lighting = sun_at(48.0, 0.0);
  lighting.sky_illuminance_lux = 16000.0;
  const render::Sky sky(lighting, false);
  const dvec3 zenith = sky.radiance({0, 0, 1});
  EXPECT_GT(render::luminance(zenith), 2000.0);
  EXPECT_LT(render::luminance(zenith), 4000.0);
  EXPECT_LT(chromaticity(zenith).x, 0.28);
  EXPECT_GT(chromaticity(zenith).x, 0.235);
  EXPECT_LT(chromaticity(zenith).y, 0.29);
  EXPECT_GT(chromaticity(zenith).y, 0.235);
  const dvec3 side = sky.radiance(glm::normalize(dvec3(0.0, 1.0, 0.05)));
  EXPECT_GT(render::luminance(side), 2.0 * render::luminance(zenith));
  EXPECT_LT(render::luminance(side), 4.0 * render::luminance(zenith));
  EXPECT_NEAR(chromaticity(side).x, 0.30, 0.02);
}

TEST(Sky, WhiteIsTheDaylightOfTheModel) {
  const render::Atmosphere air(2.0, 0.25 * pi, 0.15);
  const dvec3 card = air.direct_illuminance() * std::sqrt(0.5) + air.sky_illuminance();
  for (int c = 0; c < 3; ++c)
    EXPECT_NEAR(card[c] / render::luminance(card), render::daylight_white[c], 5e-6) << c;
}

TEST(Sky, EveningIsWarmAndTwilightBlue) {
  const render::Sky evening(sun_at(5.0), false), dusk(sun_at(-5.0, 0.0), false);
  EXPECT_GT(evening.key_illuminance().x, 2.0 * evening.key_illuminance().z);
  const dvec3 zenith = dusk.radiance({0, 0, 1});
  EXPECT_GT(zenith.z, 2.0 * zenith.x);
  // The orange glow stands where the sun has set.
  const dvec3 glow = dusk.radiance(glm::normalize(dvec3(1.0, 0.0, 0.04))),
              opposite = dusk.radiance(glm::normalize(dvec3(-1.0, 0.0, 0.04)));
  EXPECT_GT(render::luminance(glow), 3.0 * render::luminance(opposite));
  EXPECT_GT(glow.x, 2.0 * glow.z);
}

TEST(Sky, NightIsDarkButNotBlack) {
  Lighting lighting = sun_at(-40.0);
  lighting.sky_illuminance_lux = render::sunlight_lux(radians(-40.0));
  const double zenith = render::luminance(render::Sky(lighting, false).radiance({0, 0, 1}));
  EXPECT_NEAR(zenith, 1.54e-4, 1e-6);  // 22.1 mag/arcsec^2
  lighting.sky_glow_cd_m2 = 0.01;
  lighting.sky_illuminance_lux += render::night_sky_lux(0.01);
  const dvec3 city = render::Sky(lighting, false).radiance({0, 0, 1});
  EXPECT_NEAR(render::luminance(city), zenith + 0.01, 1e-6);
  EXPECT_GT(city.x, city.z);
}

TEST(Sky, RadianceChangesSmoothlyThroughSunset) {
  // The radiance has no step where one of sun, moon and airglow takes over from another.
  const auto zenith = [](double h) {
    Lighting lighting = sun_at(h, 0.0);
    lighting.sky_illuminance_lux = render::sunlight_lux(radians(h));
    return render::luminance(render::Sky(lighting, false).radiance({0, 0, 1}));
  };
  for (const double h : {2.0, 1.0, 0.0, -11.0, -18.0})
    EXPECT_NEAR(std::log10(zenith(h + 0.01) / zenith(h - 0.01)), 0.0, 0.02) << h;
}

TEST(Sky, OvercastIsThreeTimesBrighterAtTheZenith) {
  Lighting lighting = sun_at(30.0);
  lighting.sky_model = render::SkyModel::overcast;
  lighting.sun_illuminance_lux = 0.0;
  const render::Sky sky(lighting, false);
  EXPECT_NEAR(level_lux(sky) / 15000.0, 1.0, 1e-3);
  EXPECT_NEAR(render::luminance(sky.radiance({0, 0, 1})) / render::luminance(sky.radiance({1, 0, 1e-9})), 3.0,
              1e-6);
}

TEST(Sky, UniformSkyIsUniform) {
  Lighting lighting;
  lighting.sky_model = render::SkyModel::uniform;
  const render::Sky sky(lighting, false);
  const auto sh = render::sky_irradiance(sky);
  EXPECT_NEAR(sh[0].x, 15000.0 / pi, 1e-4 * 15000.0);
  for (size_t i = 1; i < sh.size(); ++i) EXPECT_NEAR(sh[i].x, 0.0, 1e-4 * 15000.0);
  EXPECT_NEAR(sky.radiance({0, 0, -1}).x, 15000.0 / pi, 1e-9);
}

TEST(Sky, HazeKeepsTheBalanceOnLevelGround) {
  for (const double depth : {0.05, 1.0, 8.0})
    for (const double elevation : {48.0, 10.0, -8.0}) {
      Lighting lighting = sun_at(elevation);
      lighting.haze_extinction_per_m = 0.01;
      lighting.haze_depth = depth;
      const render::Sky sky(lighting, true);
      EXPECT_NEAR(level_lux(sky) / sky.illuminance(), 1.0, 0.02) << depth << " " << elevation;
      const double sine = std::max(0.0, lighting.sun_direction.z), above = 1e5 * sine + 15000.0;
      const double below = render::luminance(sky.key_illuminance()) * sine + sky.illuminance();
      EXPECT_LT(below, above);
      EXPECT_GT(below, above / (1.0 + 0.075 * depth) * (1.0 - 1e-9));
      // In the horizontal direction only haze is visible.
      const dvec3 horizon = sky.radiance({1.0, 0.0, 0.0});
      EXPECT_GE(render::luminance(horizon), render::luminance(sky.haze_ambient()) * (1.0 - 1e-9));
    }
  // In a white world the air is white, too.
  Lighting white;
  white.sky_model = render::SkyModel::uniform;
  white.sun_illuminance_lux = 0.0;
  white.haze_extinction_per_m = 0.01;
  white.haze_depth = 3.0;
  const render::Sky sky(white, true);
  for (const dvec3& d : {dvec3(0, 0, 1), dvec3(1, 0, 0), dvec3(0, 0, -1), glm::normalize(dvec3(1, 1, 0.1))})
    EXPECT_NEAR(sky.radiance(d).y, 15000.0 / pi, 1e-6);
  EXPECT_NEAR(sky.haze_ambient().y, 15000.0 / pi, 1e-6);
}

}  // namespace
}  // namespace greatx::test
