// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Checks light levels, fog and rain against published figures and conservation of energy.
#include <cmath>

#include <gtest/gtest.h>

#include "core/units.h"
#include "renderer/daylight/haze.h"
#include "renderer/daylight/twilight.h"

namespace greatx::test {
namespace {

using namespace greatx::render;

TEST(Twilight, PublishedLevels) {
  // Circular 171 and the Explanatory Supplement list these illuminances of level ground, lux.
  EXPECT_NEAR(sunlight_lux(radians(90.0)), 1.29e5, 0.01e5);
  EXPECT_NEAR(sunlight_lux(0.0), 759.0, 8.0);
  EXPECT_NEAR(sunlight_lux(radians(-6.0)), 3.41, 0.03);     // end of civil twilight
  EXPECT_NEAR(sunlight_lux(radians(-12.0)), 8.1e-3, 1e-4);  // nautical
  EXPECT_NEAR(sunlight_lux(radians(-18.0)), 6.5e-4, 1e-5);  // astronomical
  EXPECT_EQ(sunlight_lux(radians(-60.0)), natural_night_lux);
  EXPECT_NEAR(full_moonlight_lux(radians(90.0)), 0.27, 0.005);
  EXPECT_EQ(full_moonlight_lux(radians(-3.0)), 0.0);
  EXPECT_NEAR(moon_phase_share(radians(90.0)), 0.091, 0.002);
  EXPECT_EQ(moon_phase_share(0.0), 1.0);
}

TEST(Twilight, ContinuousAndRising) {
  // The level changes by less than 0.6 decades per degree, here in steps of a thousandth of a degree.
  const double step = 1e-3, most = std::pow(10.0, 0.6 * step) - 1.0 + 1e-12;
  for (double h = -20.0; h < 90.0; h += step) {
    const double a = sunlight_lux(radians(h)), b = sunlight_lux(radians(h + step));
    ASSERT_LE(std::abs(b / a - 1.0), most) << h;
    ASSERT_GE(b, a * (1.0 - 1e-9)) << h;
    const double c = overcast_lux(radians(h)), d = overcast_lux(radians(h + step));
    ASSERT_LE(std::abs(d / c - 1.0), most) << h;
    ASSERT_LE(std::abs(full_moonlight_lux(radians(h + step)) - full_moonlight_lux(radians(h))), 2e-5) << h;
  }
}

TEST(Haze, PublishedVisibilities) {
  // Kunkel 1984: V = 0.027 M^-0.88 km at a contrast of 2 %.
  for (const double water : {0.01, 0.05, 0.5}) {
    EXPECT_NEAR(visibility_m(fog_extinction(water)) / (27.0 * std::pow(water, -0.88)), 1.0, 2e-3);
    EXPECT_NEAR(std::exp(-fog_extinction(water) * visibility_m(fog_extinction(water))), 0.02, 1e-12);
  }
  // ITU-R P.1814: rain of 25 mm/h attenuates by 9.3 dB/km.
  EXPECT_NEAR(-10.0 * std::log10(std::exp(-1000.0 * rain_extinction(25.0))), 1.076 * std::pow(25.0, 0.67),
              1e-9);
  EXPECT_EQ(fog_extinction(0.0), 0.0);
  EXPECT_EQ(rain_extinction(0.0), 0.0);
  EXPECT_TRUE(std::isinf(visibility_m(0.0)));
}

TEST(Haze, ALayerLosesOnlyWhatGoesBackUp) {
  const double sine = 0.6, direct = 9e4, sky = 1.5e4;
  // An empty layer changes nothing. Over white ground no light is lost.
  EXPECT_DOUBLE_EQ(through_layer(direct, sine, sky, 0.0, 0.15).direct_lux, direct);
  EXPECT_DOUBLE_EQ(through_layer(direct, sine, sky, 0.0, 0.15).sky_lux, sky);
  double before = direct * sine + sky;
  for (const double depth : {0.1, 1.0, 8.0, 50.0}) {
    const LayerLight white = through_layer(direct, sine, sky, depth, 1.0);
    EXPECT_NEAR(white.direct_lux * sine + white.sky_lux, direct * sine + sky, 1e-6);
    const LayerLight dark = through_layer(direct, sine, sky, depth, 0.15);
    EXPECT_NEAR(dark.direct_lux, direct * std::exp(-depth / sine), 1e-9 * direct);
    EXPECT_GT(dark.sky_lux, 0.0);
    const double total = dark.direct_lux * sine + dark.sky_lux;
    EXPECT_LT(total, before);
    before = total;
  }
  // A sun below the horizon sends no direct light through the layer.
  EXPECT_EQ(through_layer(direct, -0.1, sky, 1.0, 0.0).direct_lux, 0.0);
}

}  // namespace
}  // namespace greatx::test
