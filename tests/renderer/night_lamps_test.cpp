// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Checks shadows of lamps, their light in fog, and the glare of a lens.
#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

#include "renderer/daylight/haze.h"
#include "renderer/light/lamp_shadow.h"
#include "shaders/shared/weather.h"
#include "tests/renderer/camera_rig.h"

namespace greatx::test {
namespace {

scene::PunctualLight lamp_at(const dvec3& position, float candelas) {
  scene::PunctualLight lamp;
  lamp.name = "lamp";
  lamp.position = position;
  lamp.intensity = candelas;
  return lamp;
}

TEST(LampShadow, OfAPoleFallsWhereGeometrySays) {
  // A pole of 3 m stands 2 m beside a lamp 8 m high, so its shadow ends 2 * 8 / (8 - 3) = 3.2 m beside it.
  const dvec3 low(2.0, -0.4, 0.0), high(2.2, 0.4, 3.0);
  for (const bool moving : {false, true}) {
    TinyScene tiny;
    tiny.object("ground", 0, tiny.material_as(optical_material("grey", 0.5f)))
        .quad({-12, -12, 0}, {12, -12, 0}, {12, 12, 0}, {-12, 12, 0});
    const uint32_t body = moving ? tiny.body("pole") : 0;
    tiny.object("pole", body).box(low, high);
    scene::Scene scene = tiny.build();
    const dvec3 lamp(0.0, 0.0, 8.0);
    scene.lights.push_back(lamp_at(lamp, 800.0f));
    render::CameraEffects effects = lambertian();
    effects.sun = effects.sky = false;
    effects.lamp_shadows = true;
    render::CameraDesc desc = plain_camera(160, 1);
    desc.exposure_ev100 = 5.0;
    CameraRig rig(std::move(scene), plain_light(), desc, effects);
    const Pose sensor = look({3, 0, 7}, 0.0, 90.0);
    const double texel = 2.0 * 8.0 * std::tan(render::lamp_tile_half_angle) / render::most_lamp_tile;
    for (const double aside : {0.0, 1.5}) {
      const Pose placed{{0.0, moving ? aside : 0.0, 0.0}, {1, 0, 0, 0}};
      const render::CameraImages images = rig.shoot(sensor, {placed});
      const auto blocked = [&](const dvec3& p, double by) {
        const dvec3 a = (low + placed.position - by - p) / (lamp - p + 1e-9),
                    b = (high + placed.position + by - p) / (lamp - p + 1e-9);
        const dvec3 n = glm::min(a, b), f = glm::max(a, b);
        return std::max({n.x, n.y, n.z, 0.0}) < std::min({f.x, f.y, f.z, 1.0});
      };
      size_t dark = 0, lit = 0;
      double farthest = 0.0;
      for (uint32_t row = 0; row < desc.height; ++row)
        for (uint32_t column = 0; column < desc.width; ++column) {
          const size_t i = size_t(row) * desc.width + column;
          if (images.instance[i] != 1) continue;
          const dvec3 p = sensor.apply(pixel_ray(desc, column, row) * double(images.depth[i]));
          const dvec3 to_lamp = lamp - p;
          const double d = glm::length(to_lamp), expected = 0.5 / pi * 800.0 * to_lamp.z / (d * d * d);
          const double found = luminance_at(images, i), margin = texel;
          if (!blocked(p, margin)) {
            EXPECT_NEAR(found / expected, 1.0, 3e-3) << p.x << " " << p.y << " " << moving;
            ++lit;
          } else if (blocked(p, -0.09) && p.x > high.x + 2.0 * texel) {
            EXPECT_EQ(found, 0.0) << p.x << " " << p.y << " " << moving;
            ++dark;
          }
          if (found < 0.5 * expected) farthest = std::max(farthest, p.x);
        }
      EXPECT_GT(dark, 30u);
      EXPECT_GT(lit, 15000u);
      EXPECT_NEAR(farthest, 2.2 * 8.0 / 5.0, 1.5 * texel) << "the far edge of the pole's top";
    }
  }
}

TEST(LampShadow, OnlyLampsThatStandStillHaveTiles) {
  TinyScene tiny;
  const uint32_t car = tiny.body("car");
  tiny.object("ground").quad({-9, -9, 0}, {9, -9, 0}, {9, 9, 0}, {-9, 9, 0});
  tiny.object("car", car).box({-1, -1, 0}, {1, 1, 1});
  scene::Scene scene = tiny.build();
  scene.lights = {lamp_at({0, 0, 8}, 800.0f), lamp_at({0, 0, 1}, 800.0f), lamp_at({0, 0, 8}, 80.0f)};
  scene.lights[1].body = car;
  scene.lights[2].type = scene::PunctualLight::Type::directional;
  const scene::GpuScene gpu(device(), scene, {.acceleration_structure = false, .textures = true});
  const render::LampShadows shadows(gpu, {.wanted = true, .alpha_mask = true});
  EXPECT_EQ(shadows.tile_count(), 1u);
  EXPECT_NE(shadows.tiles()[0].across, dvec3(0.0));
  EXPECT_EQ(shadows.tiles()[1].across, dvec3(0.0));
  EXPECT_EQ(shadows.tiles()[2].across, dvec3(0.0));
  EXPECT_EQ(shadows.tile_texels(), render::most_lamp_tile);
}

/// Returns the airlight integral by many small steps.
double airlight(const scene::PunctualLight& lamp, const dvec3& ray, double far, double extinction) {
  constexpr int steps = 200000;
  double sum = 0.0;
  for (int i = 0; i < steps; ++i) {
    const double t = far * (i + 0.5) / steps;
    const dvec3 way = ray * t - lamp.position;
    const double r = glm::length(way);
    const double window = std::clamp(1.0 - std::pow(r / lamp.range_m, 4.0), 0.0, 1.0);
    const double inner = std::cos(lamp.inner_cone), outer = std::cos(lamp.outer_cone);
    const double cone = std::clamp((glm::dot(way, lamp.direction) / r - outer) / (inner - outer), 0.0, 1.0);
    const double phase =
        double(shared::henyey_greenstein(float(glm::dot(way / r, -ray)), float(render::haze_asymmetry)));
    const double shape = lamp.type == scene::PunctualLight::Type::spot ? cone * cone : 1.0;
    sum += shape * window * phase * std::exp(-extinction * (t + r)) / (r * r);
  }
  return lamp.intensity * extinction * sum * far / steps;
}

TEST(LampHalo, IsTheAirlightIntegral) {
  for (const bool spot : {false, true}) {
    TinyScene tiny;
    tiny.object("wall", 0, tiny.material_as(optical_material("black", 0.0f)))
        .quad({40, 90, -90}, {40, 0, -90}, {40, 0, 90}, {40, 90, 90});
    scene::Scene scene = tiny.build();
    scene::PunctualLight lamp = lamp_at({18.0, -3.0, 6.0}, 3000.0f);
    lamp.range_m = 60.0f;
    if (spot) {
      lamp.type = scene::PunctualLight::Type::spot;
      lamp.direction = {0.0, 0.0, -1.0};
      lamp.inner_cone = 0.9f;
      lamp.outer_cone = 1.45f;
    }
    scene.lights.push_back(lamp);
    render::Lighting light = plain_light();
    light.sun_illuminance_lux = 0.0;
    light.sky_illuminance_lux = 1e-6;
    light.haze_extinction_per_m = 0.02;
    render::CameraEffects effects = lambertian();
    effects.haze = effects.lamp_halos = true;
    render::CameraDesc desc = plain_camera(40, 1);
    desc.exposure_ev100 = 0.0;
    CameraRig rig(std::move(scene), light, desc, effects);
    const render::CameraImages images = rig.shoot(look({0, 0, 0}));
    double squares = 0.0, whole = 0.0;
    for (uint32_t row = 0; row < desc.height; row += 3)
      for (uint32_t column = 0; column < desc.width; column += 3) {
        const size_t i = size_t(row) * desc.width + column;
        const dvec3 toward = pixel_ray(desc, column, row), ray = glm::normalize(toward);
        const double far = std::isinf(images.depth[i]) ? 100.0 : images.depth[i] * glm::length(toward);
        const double expected = airlight(lamp, ray, far, light.haze_extinction_per_m);
        squares += std::pow(luminance_at(images, i) - expected, 2.0);
        whole += expected * expected;
        EXPECT_NEAR(luminance_at(images, i), expected, 0.08 * expected + 2e-3)
            << column << " " << row << spot;
      }
    EXPECT_GT(whole, 0.0);
    EXPECT_LT(std::sqrt(squares / whole), 0.03) << spot;  // docs/light.md states this
  }
}

TEST(Glare, KeepsTheLightAndFallsWithTheSquareOfTheAngle) {
  TinyScene tiny;
  scene::Material glow = optical_material("glow", 0.0f);
  glow.pbr.emissive = vec3(100.0f);
  tiny.object("lamp", 0, tiny.material_as(glow))
      .quad({10, 0.1, -0.1}, {10, -0.1, -0.1}, {10, -0.1, 0.1}, {10, 0.1, 0.1});
  const scene::Scene scene = tiny.build();
  render::CameraEffects effects = lambertian();
  effects.sun = effects.sky = false;
  render::CameraDesc desc = plain_camera(256, 1);
  const Pose sensor = look({0, 0, 0});
  CameraRig clean(scene, plain_light(), desc, effects);
  desc.glare = 0.2;
  CameraRig hazed(scene, plain_light(), desc, effects);
  const render::CameraImages without = clean.shoot(sensor), with = hazed.shoot(sensor);
  double sum = 0.0, sum_with = 0.0, away = 0.0;
  std::array<double, 3> ring{}, count{};
  for (uint32_t row = 0; row < desc.height; ++row)
    for (uint32_t column = 0; column < desc.width; ++column) {
      const size_t i = size_t(row) * desc.width + column;
      sum += luminance_at(without, i);
      sum_with += luminance_at(with, i);
      if (luminance_at(without, i) == 0.0) away += luminance_at(with, i);
      const double r = std::hypot(column + 0.5 - 128.0, row + 0.5 - 128.0);
      for (size_t k = 0; k < ring.size(); ++k)
        if (std::abs(r - 8.0 * std::exp2(double(k))) < 1.0) ring[k] += luminance_at(with, i), ++count[k];
    }
  ASSERT_GT(sum, 0.0);
  EXPECT_NEAR(sum_with / sum, 1.0, 0.02);
  EXPECT_NEAR(away / sum, 0.2, 0.03);
  for (size_t k = 0; k < 2; ++k)
    EXPECT_NEAR(std::log2(ring[k] / count[k] / (ring[k + 1] / count[k + 1])), 2.0, 0.5) << k;
}

}  // namespace
}  // namespace greatx::test
