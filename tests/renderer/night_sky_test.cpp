// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Checks the number of stars, fluxes of stars and moon at any resolution, and shadows by moonlight.
#include "renderer/light/night_sky.h"

#include <cmath>

#include <gtest/gtest.h>

#include "renderer/daylight/almanac.h"
#include "tests/renderer/camera_rig.h"

namespace greatx::test {
namespace {

render::Lighting night() {
  render::Lighting light = plain_light(0.0, -40.0);
  light.sky_illuminance_lux = 1e-9;  // so that only stars and moon count
  return light;
}

render::CameraEffects starry() {
  render::CameraEffects effects = lambertian();
  effects.night_sky = true;
  return effects;
}

TinyScene far_below() {
  TinyScene tiny;
  tiny.object("speck").box({-1, -1, -2001}, {1, 1, -2000});
  return tiny;
}

/// Returns the illuminance from the pixels of the picture: luminance times solid angle.
double picture_lux(const render::CameraDesc& desc, const render::CameraImages& images) {
  double sum = 0.0;
  for (uint32_t row = 0; row < desc.height; ++row)
    for (uint32_t column = 0; column < desc.width; ++column) {
      const double d = glm::length(pixel_ray(desc, column, row));
      sum += luminance_at(images, row * desc.width + column) / (desc.fx * desc.fy * d * d * d);
    }
  return sum;
}

TEST(NightSky, StarsAreAsManyAsCounted) {
  const std::vector<render::Star> stars = render::draw_stars(7);
  for (const auto& [magnitude, count] : {std::pair{2.0, 48.0}, {4.0, 513.0}, {6.0, 4797.0}}) {
    const auto found =
        std::ranges::count_if(stars, [&](const render::Star& s) { return s.magnitude < magnitude; });
    EXPECT_NEAR(double(found), count, 1.0 + 0.01 * count) << magnitude;
  }
  // The stars are uniform on the sphere: half of them are above the horizon, within four standard deviations.
  const auto above = std::ranges::count_if(
      stars, [](const render::Star& s) { return std::isfinite(s.magnitude) && s.direction.z > 0.0; });
  EXPECT_NEAR(double(above), 2400.0, 140.0);
  const std::vector<render::Star> others = render::draw_stars(8);
  size_t same = 0;
  for (size_t i = 0; i < stars.size(); ++i)
    same += std::isfinite(stars[i].magnitude) && others[i].direction == stars[i].direction;
  EXPECT_EQ(same, 0u);
}

TEST(NightSky, StarsKeepTheirLightAtEveryResolution) {
  const render::Lighting light = night();
  double expected = 0.0;  // from the stars in the picture
  const auto packed = render::gpu_stars(render::draw_stars(light.star_seed), 0.0);
  const auto drawn = render::draw_stars(light.star_seed);
  for (size_t i = 0; i < drawn.size(); ++i) {
    const dvec3& d = drawn[i].direction;
    // The camera looks up and sees |x|, |y| < z. The tolerance covers stars at the rim, where the width of a
    // pixel matters.
    if (!std::isfinite(drawn[i].magnitude) || packed[i].light == 0) continue;
    const double rim = std::max(std::abs(d.x), std::abs(d.y)) / d.z;
    if (d.z > 0.0 && rim < 1.0)
      // The air mass is 1/z. This approximation is good to 0.3 % at 45 degrees.
      expected += render::magnitude_0_lux * std::pow(10.0, -0.4 * (drawn[i].magnitude + 0.19 / d.z));
  }
  for (const uint32_t size : {160u, 320u, 900u}) {
    render::CameraDesc desc = plain_camera(size, 1);
    desc.exposure_ev100 = -10.0;
    CameraRig rig(far_below().build(), light, desc, starry());
    const render::CameraImages images = rig.shoot(look({0, 0, 0}, 0.0, -90.0));
    EXPECT_NEAR(picture_lux(desc, images) / expected, 1.0, 0.04) << size;
  }
}

TEST(NightSky, MoonsDiscHasItsIlluminanceAtEveryPhaseAndResolution) {
  for (const double phase_deg : {0.0, 60.0, 110.0})
    for (const double fx : {60.0, 400.0, 4000.0}) {
      render::Lighting light = night();
      light.moon_direction = dvec3(0.0, 0.0, 1.0);
      light.moon_illuminance_lux = 0.2;
      light.moon_phase_angle = radians(phase_deg);
      render::CameraDesc desc = plain_camera(100, 1);
      desc.fx = desc.fy = fx;
      desc.exposure_ev100 = 5.0;
      render::CameraEffects effects = starry();
      CameraRig rig(far_below().build(), light, desc, effects);
      // The moon is not aligned with the grid of pixels.
      const render::CameraImages images = rig.shoot(look({0, 0, 0}, 20.0, -90.0 + 10.3 / fx));
      EXPECT_NEAR(picture_lux(desc, images) / 0.2, 1.0, fx > 1000.0 ? 0.02 : 0.1) << phase_deg << " " << fx;
    }
}

TEST(NightSky, BrightLimbLooksTowardsTheSun) {
  render::Lighting light = night();
  light.sun_direction =
      render::Lighting::direction(0.0, radians(-5.0));  // below the horizon in the east (+x)
  light.moon_direction = render::Lighting::direction(0.5 * pi, radians(30.0));
  light.moon_illuminance_lux = 0.02;
  light.moon_phase_angle = radians(90.0);
  render::CameraDesc desc = plain_camera(101, 1);
  desc.fx = desc.fy = 8000.0;
  desc.exposure_ev100 = 8.0;
  CameraRig rig(far_below().build(), light, desc, starry());
  const render::CameraImages images = rig.shoot(look({0, 0, 0}, 90.0, -30.0));  // east is to the right
  double left = 0.0, right = 0.0;
  for (uint32_t row = 0; row < 101; ++row)
    for (uint32_t column = 0; column < 101; ++column)
      (column < 50 ? left : right) += luminance_at(images, row * 101 + column);
  EXPECT_GT(right, 3.0 * left);
}

TEST(NightSky, TheMoonCastsShadows) {
  // A sun with the light and the position of the moon casts the same shadow.
  const auto shot = [](bool moon) {
    TinyScene tiny;
    tiny.object("ground", 0, tiny.material_as(optical_material("grey", 0.5f)))
        .quad({-30, -30, 0}, {30, -30, 0}, {30, 30, 0}, {-30, 30, 0});
    tiny.object("box").box({-1, -1, 0}, {1, 1, 3});
    render::Lighting light = plain_light(35.0, moon ? -30.0 : 40.0);
    light.sky_illuminance_lux = 0.0;
    light.sun_illuminance_lux = moon ? 1e5 : 0.2;
    if (moon) {
      light.moon_direction = render::Lighting::direction(radians(35.0), radians(40.0));
      light.moon_illuminance_lux = 0.2;
    }
    render::CameraDesc desc = plain_camera(64, 1);
    desc.exposure_ev100 = -3.0;
    CameraRig rig(tiny.build(), light, desc, lambertian());
    return rig.shoot(look({0, 0, 10}, 0.0, 90.0));
  };
  const render::CameraImages sun = shot(false), moon = shot(true);
  size_t dark = 0;
  for (size_t i = 0; i < sun.depth.size(); ++i) {
    const double expected = luminance_at(sun, i);
    EXPECT_NEAR(luminance_at(moon, i), expected, 3e-3 * expected + 1e-9) << i;
    dark += expected == 0.0;
  }
  EXPECT_GT(dark, 40u);
  // Moonlight is slightly warmer than sunlight from the same height.
  EXPECT_GT(moon.hdr[0] / moon.hdr[2], sun.hdr[0] / sun.hdr[2]);
}

}  // namespace
}  // namespace greatx::test
