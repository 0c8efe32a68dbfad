// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Checks water, snow and falling drops in pictures against closed forms.
#include "shaders/shared/weather.h"

#include <cmath>
#include <numeric>

#include <gtest/gtest.h>

#include "renderer/daylight/haze.h"
#include "shaders/shared/brdf.h"
#include "tests/renderer/camera_rig.h"

namespace greatx::test {
namespace {

/// Returns the reflectance of a flat face of water at a cosine, for unpolarised light (Fresnel).
double water_reflectance(double cosine) {
  const double n = shared::water_index, in = std::sqrt(1.0 - (1.0 - cosine * cosine) / (n * n));
  const double s = (cosine - n * in) / (cosine + n * in), p = (in - n * cosine) / (in + n * cosine);
  return 0.5 * (s * s + p * p);
}

TEST(WetSurface, ConstantsAreThoseOfWater) {
  EXPECT_NEAR(shared::water_f0, water_reflectance(1.0), 1e-6);
  // The mean over diffuse light is the integral of 2 cos R(cos) over the cosine.
  double mean = 0.0;
  constexpr int steps = 20000;
  for (int i = 0; i < steps; ++i) {
    const double cosine = (i + 0.5) / steps;
    mean += 2.0 * cosine * water_reflectance(cosine) / steps;
  }
  const double n = shared::water_index;
  EXPECT_NEAR(shared::water_traps, 1.0 - (1.0 - mean) / (n * n), 1e-3);
}

TEST(WetSurface, AlbedoIsTheSumOfAllReflectionsInTheFilm) {
  for (const float dry : {0.0f, 0.05f, 0.2f, 0.5f, 0.9f, 1.0f}) {
    double sum = 0.0, inside = 1.0;
    for (int i = 0; i < 2000; ++i) {
      inside *= dry;                                // scattered up by the ground
      sum += inside * (1.0 - shared::water_traps);  // leaves
      inside *= shared::water_traps;                // is sent down again
    }
    EXPECT_NEAR(shared::wet_albedo(vec3(dry)).x, sum, 1e-6) << dry;
  }
  EXPECT_NEAR(shared::wet_albedo(vec3(0.2f)).x, 0.1166, 1e-4);  // dry asphalt in the sun
}

TinyScene open_ground(float gray, double half = 30.0) {
  TinyScene tiny;
  tiny.object("ground", 0, tiny.material_as(optical_material("ground", gray)))
      .quad({-half, -half, 0}, {half, -half, 0}, {half, half, 0}, {-half, half, 0});
  return tiny;
}

render::CameraEffects wet() {
  render::CameraEffects effects = lambertian();
  effects.wet_surfaces = true;
  return effects;
}

TEST(WetSurface, GroundUnderTheSkyIsDarkAndGroundUnderARoofIsDry) {
  TinyScene tiny = open_ground(0.5f);
  tiny.object("roof").box({2, -20, 4}, {20, 20, 4.2});
  render::Lighting light = plain_light(0.0, 90.0);
  light.sun_illuminance_lux = 0.0;
  light.wetness = 1.0;
  render::CameraEffects effects = wet();
  CameraRig rig(tiny.build(), light, plain_camera(32, 1), effects);
  const render::CameraImages images = rig.shoot(look({1, 0, 3}, 0.0, 90.0));
  const double sky = 15000.0 / pi;
  // Rows go from the front (x up to 4) to the back of the picture.
  const double dry = luminance_at(images, size_t(2) * 32 + 16),
               soaked = luminance_at(images, size_t(29) * 32 + 16);
  EXPECT_NEAR(dry / (0.5 * sky), 1.0, 1e-3);
  EXPECT_NEAR(soaked / (shared::wet_albedo(vec3(0.5f)).x * sky), 1.0, 1e-3);
}

TEST(WetSurface, PuddlesCoverTheirShareOfLevelGround) {
  for (const double share : {0.1, 0.3, 0.6}) {
    render::Lighting light = plain_light(0.0, 90.0);
    light.puddles = share;
    CameraRig rig(open_ground(0.5f, 100.0).build(), light, plain_camera(256, 1), wet());
    const render::CameraImages images = rig.shoot(look({0, 0, 60}, 0.0, 90.0));
    const double dry = 0.5 * 115000.0 / pi, water = dry * shared::wet_albedo(vec3(0.5f)).x / 0.5;
    size_t under = 0;
    for (size_t i = 0; i < images.depth.size(); ++i) under += luminance_at(images, i) < 0.5 * (dry + water);
    EXPECT_NEAR(double(under) / double(images.depth.size()), share, 0.05);
  }
}

TEST(WetSurface, APuddleMirrorsWhatStandsBehindIt) {
  // A glowing wall stands behind a sheet of water. Fresnel's reflectance at the angle of each pixel gives the
  // luminance of its image.
  TinyScene tiny;
  scene::Material glow = optical_material("glow", 0.0f);
  glow.pbr.emissive = vec3(3.0f);
  tiny.object("ground", 0, tiny.material_as(optical_material("black", 0.0f)))
      .quad({-30, -30, 0}, {30, -30, 0}, {30, 30, 0}, {-30, 30, 0});
  tiny.object("wall", 0, tiny.material_as(glow)).quad({12, 25, 0}, {12, -25, 0}, {12, -25, 20}, {12, 25, 20});
  render::Lighting light = plain_light();
  light.puddles = 1.0;
  render::CameraEffects effects;
  effects.sun = effects.sky = false;
  effects.wet_surfaces = true;
  const render::CameraDesc desc = plain_camera(96, 1);
  CameraRig rig(tiny.build(), light, desc, effects);
  const Pose sensor = look({0, 0, 2});
  const render::CameraImages images = rig.shoot(sensor);
  size_t checked = 0;
  for (uint32_t row = 0; row < desc.height; ++row) {
    const size_t i = size_t(row) * desc.width + desc.width / 2;
    const dvec3 ray = glm::normalize(pixel_ray(desc, desc.width / 2, row));
    if (images.instance[i] != 1 || ray.z > -0.18 || ray.z < -0.6) continue;
    // The albedo of the lobe is fitted to 0.06 (shaders/shared/brdf.h), and Schlick's term is up to 0.08
    // above Fresnel's reflectance of water.
    const auto cosine = float(-ray.z);
    const shared::Reflectance water =
        shared::reflectance_below(vec3(0.0f), 0.0f, shared::puddle_roughness, cosine, shared::water_f0);
    const float lobe = water.albedo.x;
    EXPECT_NEAR(luminance_at(images, i) / 3000.0, lobe, 0.01) << row;
    const double schlick = shared::schlick_fresnel(vec3(shared::water_f0), 1.0f - cosine).x;
    EXPECT_NEAR(lobe, schlick, 0.06) << row;
    EXPECT_NEAR(schlick, water_reflectance(cosine), 0.08) << row;
    ++checked;
  }
  EXPECT_GT(checked, 15u);
}

TEST(Snow, CoversWhatFacesUpwardsUnderTheSky) {
  TinyScene tiny = open_ground(0.1f);
  tiny.object("roof").box({2, -20, 4}, {20, 20, 4.2});
  render::Lighting light = plain_light(0.0, 90.0);
  light.sun_illuminance_lux = 0.0;
  light.snow = 1.0;
  render::CameraEffects effects = lambertian();
  effects.snow_cover = true;
  CameraRig rig(tiny.build(), light, plain_camera(32, 1), effects);
  const render::CameraImages images = rig.shoot(look({1, 0, 3}, 0.0, 90.0));
  EXPECT_NEAR(luminance_at(images, size_t(2) * 32 + 16) / (0.1 * 15000.0 / pi), 1.0, 2e-3);
  EXPECT_NEAR(luminance_at(images, size_t(29) * 32 + 16) / (0.85 * 15000.0 / pi), 1.0, 2e-3);
}

// --- falling drops

TEST(Rain, DropsFallAsFastAsGunnAndKinzerMeasured) {
  // R. Gunn and G. D. Kinzer, "The terminal velocity of fall for water droplets in stagnant air", J. Meteor.
  // 6 (1949), table 2: mm, m/s.
  for (const auto& [diameter, speed] :
       {std::pair(1.0f, 4.03), std::pair(2.0f, 6.49), std::pair(3.0f, 8.06), std::pair(5.0f, 9.09)})
    EXPECT_NEAR(shared::terminal_velocity(diameter), speed, 0.15) << diameter;
}

TEST(Rain, DropsCarryTheRainThatFalls) {
  // The flux of water of Marshall and Palmer's drops at their speeds is the rain, to the accuracy of the law.
  for (const double rain : {2.0, 10.0, 50.0}) {
    const double slope = 4.1 * std::pow(rain, -0.21);
    double flux = 0.0;
    for (double d = 0.005; d < 8.0; d += 0.01)
      flux +=
          8000.0 * std::exp(-slope * d) * 0.01 * pi / 6.0 * d * d * d * shared::terminal_velocity(float(d));
    EXPECT_NEAR(flux * 1e-9 * 3600.0 * 1000.0 / rain, 1.0, 0.2) << rain;
    // The drops that are drawn are a part of these.
    const render::FallingDrops drops = render::falling_drops(rain);
    double number = 0.0, area = 0.0;
    for (double d = shared::least_drop_mm + 0.005; d < 30.0; d += 0.01) {
      number += 8000.0 * std::exp(-slope * d) * 0.01;
      area += 8000.0 * std::exp(-slope * d) * 0.01 * 0.25 * pi * d * d * 1e-6;
    }
    EXPECT_NEAR(drops.per_m3 / number, 1.0, 1e-3);
    EXPECT_NEAR(drops.extinction_per_m / area, 1.0, 1e-3);
    EXPECT_LT(drops.extinction_per_m, render::rain_extinction(rain)) << "haze holds the rest";
  }
}

double mean_luminance(const render::CameraImages& images) {
  double sum = 0.0;
  for (size_t i = 0; i < size_t{images.width} * images.height; ++i) sum += luminance_at(images, i);
  return sum / (double(images.width) * images.height);
}

TEST(Rain, StreaksHideTheAreaOfTheirDrops) {
  // Before an even sky the mean picture loses what the discs of all drops hide, for any exposure time.
  render::Lighting light = white_world();
  light.rain_mm_h = 25.0;
  render::CameraEffects effects = lambertian();
  effects.rain_streaks = true;
  const render::FallingDrops drops = render::falling_drops(light.rain_mm_h);
  const scene::Scene far = TinyScene{}.object("far").box({500, 500, 500}, {501, 501, 501}).build();
  CameraRig dry(far, light, plain_camera(256, 1), lambertian());
  const double sky = mean_luminance(dry.shoot(look({0, 0, 0})));  // as halves hold it
  const double glow = shared::drop_brightness * 0.5 * (1.0 + light.ground_albedo) * 15000.0 / pi;
  const double depth = drops.extinction_per_m * (drops.reach_m - 0.3);
  for (const double shutter : {1e-4, 2e-3, 2e-2}) {
    render::CameraDesc desc = plain_camera(256, 1);
    desc.rain.shutter_s = shutter;
    desc.outputs.hdr = true;
    CameraRig rig(far, light, desc, effects);
    double hidden = 0.0;
    constexpr int pictures = 4;
    std::vector<float> before;
    for (int tick = 0; tick < pictures; ++tick) {
      const render::CameraImages images = rig.collect(rig.record(look({0, 0, 0}), {}, {0, tick}));
      hidden += (sky - mean_luminance(images)) / (sky - glow) / pictures;
      EXPECT_NE(images.hdr, before) << "other drops at another tick";
      before = images.hdr;
    }
    EXPECT_NEAR(hidden / depth, 1.0, 0.08) << shutter;
    const auto again = rig.collect(rig.record(look({0, 0, 0}), {}, {0, pictures - 1}));
    EXPECT_EQ(again.hdr, before);
  }
}

TEST(Rain, StreaksAndHazeTogetherTakeWhatTheRainTakes) {
  // A wall glows behind the rain. The streaks take their part out of the haze, so that the mean stays.
  TinyScene tiny;
  scene::Material glow = optical_material("glow", 0.0f);
  glow.pbr.emissive = vec3(20.0f);
  tiny.object("wall", 0, tiny.material_as(glow)).quad({9, 50, -50}, {9, -50, -50}, {9, -50, 50}, {9, 50, 50});
  const scene::Scene scene = tiny.build();
  render::Lighting light = plain_light();
  light.sun_illuminance_lux = 0.0;
  light.sky_illuminance_lux = 10.0;
  light.rain_mm_h = 50.0;
  light.haze_extinction_per_m = render::rain_extinction(light.rain_mm_h);
  render::CameraEffects effects = lambertian();
  effects.haze = true;
  render::CameraDesc desc = plain_camera(256, 1);
  desc.fx = desc.fy = 500.0;  // a narrow view, so that distance and planar depth are nearly the same
  CameraRig smooth(scene, light, desc, effects);
  effects.rain_streaks = true;
  CameraRig streaked(scene, light, desc, effects);
  const Pose sensor = look({0, 0, 0});
  const double without = mean_luminance(smooth.shoot(sensor)), with = mean_luminance(streaked.shoot(sensor));
  const double lost = 1.0 - std::exp(-9.0 * light.haze_extinction_per_m);
  EXPECT_NEAR(without / 20000.0, 1.0 - lost, 0.1 * lost);
  // What differs is the rounding of halves and the drops nearer than the nearest one.
  EXPECT_NEAR(with / without, 1.0, 0.12 * lost);
}

}  // namespace
}  // namespace greatx::test
