// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "renderer/light/horizon.h"

#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

#include "tests/renderer/camera_rig.h"

namespace greatx::test {
namespace {

using render::HorizonKind;

constexpr float albedo = 0.3f;

/// Level ground of 100 m x 100 m.
scene::Scene field() {
  TinyScene tiny;
  const uint32_t grey = tiny.material_as(optical_material("grey", albedo));
  tiny.object("ground", 0, grey).quad({-50, -50, 2}, {50, -50, 2}, {50, 50, 2}, {-50, 50, 2});
  return tiny.build();
}

render::Lighting sunny(HorizonKind kind) {
  render::Lighting lighting = plain_light(20.0, 40.0);
  lighting.horizon = kind;
  return lighting;
}

render::CameraEffects with_horizon(bool on = true) {
  render::CameraEffects effects = lambertian();
  effects.horizon = on;
  return effects;
}

TEST(Horizon, PlainLandHasTheRadianceOfItsClosedForm) {
  // A level Lambertian plane has rho (E_sun sin h + E_sky) / pi. Clear air takes e^(-sigma d) of it and adds
  // the radiance of the sky over the horizon in its place.
  const render::Lighting lighting = sunny(HorizonKind::plain);
  const render::CameraDesc desc = plain_camera(128);
  CameraRig rig(field(), lighting, desc, with_horizon());
  const Pose eye = look({0, 0, 42}, 30.0, 0.0);
  const render::CameraImages images = rig.shoot(eye);
  const render::Sky sky(lighting, false);
  const double plane = double(albedo) * (1e5 * std::sin(radians(40.0)) + 15000.0) / pi;
  const double sigma = render::clear_air_extinction(lighting.turbidity);
  EXPECT_NEAR(sigma, 9.4e-5, 1e-6);  // 42 km of sight
  size_t near = 0, far = 0;
  for (uint32_t row = 0; row < desc.height; ++row)
    for (uint32_t column = 0; column < desc.width; ++column) {
      const size_t i = row * desc.width + column;
      const dvec3 ray = eye.rotate(pixel_ray(desc, column, row));
      if (images.instance[i] != 0 || ray.z > -0.02) continue;
      const double way = 40.0 / -ray.z * glm::length(ray);
      const double air =
          render::luminance(sky.radiance(glm::normalize(dvec3(dvec2(ray) / glm::length(dvec2(ray)), 0.03))));
      const double expected = air + (plane - air) * std::exp(-sigma * way);
      // The map of the sky is interpolated.
      ASSERT_NEAR(luminance_at(images, i) / expected, 1.0, 0.01) << way;
      (way < 200.0 ? near : far) += 1;
    }
  EXPECT_GT(near, 500u);
  EXPECT_GT(far, 500u);
}

TEST(Horizon, LandGoesOnWhereTheSceneEnds) {
  // From above, the ground at the scene's border and the land beyond have the same brightness.
  const render::CameraDesc desc = plain_camera(128);
  CameraRig rig(field(), sunny(HorizonKind::plain), desc, with_horizon());
  const render::CameraImages images = rig.shoot(look({0, 0, 82}, 0.0, 60.0));
  size_t borders = 0;
  for (uint32_t row = 0; row < desc.height; ++row)
    for (uint32_t column = 1; column < desc.width; ++column) {
      const size_t i = row * desc.width + column;
      if ((images.instance[i] == 0) == (images.instance[i - 1] == 0)) continue;
      EXPECT_NEAR(luminance_at(images, i) / luminance_at(images, i - 1), 1.0, 0.02);
      ++borders;
    }
  EXPECT_GT(borders, 20u);
}

TEST(Horizon, IsABackgroundOfTheRadianceAlone) {
  const render::CameraDesc desc = plain_camera(96);
  const Pose eye = look({0, 0, 20}, 100.0, 10.0);
  CameraRig without(field(), sunny(HorizonKind::city), desc, with_horizon(false));
  const render::CameraImages bare = without.shoot(eye);
  for (const HorizonKind kind : {HorizonKind::plain, HorizonKind::city, HorizonKind::country}) {
    CameraRig rig(field(), sunny(kind), desc, with_horizon());
    const render::CameraImages images = rig.shoot(eye);
    EXPECT_EQ(images.depth, bare.depth);
    EXPECT_EQ(images.instance, bare.instance);
    EXPECT_EQ(images.semantic, bare.semantic);
    size_t changed = 0, sky = 0;
    for (size_t i = 0; i < images.depth.size(); ++i) {
      if (images.instance[i] != 0) {
        EXPECT_EQ(images.hdr[3 * i], bare.hdr[3 * i]);
        continue;
      }
      EXPECT_TRUE(std::isinf(images.depth[i]));
      EXPECT_GT(luminance_at(images, i), 0.0);
      ++sky;
      changed += images.hdr[3 * i] != bare.hdr[3 * i];
    }
    EXPECT_GT(changed, sky / 5) << int(kind);
  }
}

TEST(Horizon, FogHidesTheLand) {
  render::Lighting lighting = sunny(HorizonKind::city);
  lighting.haze_extinction_per_m = 0.05;
  lighting.haze_depth = 2.0;
  render::CameraEffects effects = with_horizon();
  effects.haze = true;
  const render::CameraDesc desc = plain_camera(64);
  const Pose eye = look({0, 0, 12}, 0.0, 0.0);
  CameraRig with(field(), lighting, desc, effects);
  effects.horizon = false;
  CameraRig without(field(), lighting, desc, effects);
  const render::CameraImages seen = with.shoot(eye), bare = without.shoot(eye);
  for (size_t i = 0; i < seen.depth.size(); ++i) {
    if (seen.instance[i] != 0) continue;
    EXPECT_NEAR(luminance_at(seen, i) / luminance_at(bare, i), 1.0, 0.1) << i;
  }
}

/// The land around a town goes on with as much light as the lamps of the town give in the mean.
TEST(Horizon, IsLitAsTheSceneIs) {
  const scene::Scene scene = field();
  const render::Lighting night = plain_light(20.0, -30.0);
  const dvec3 lux(5.0, 4.0, 2.0);
  const auto land = [&](const dvec3& lamps, double sky_lux) {
    return render::describe_horizon(scene, HorizonKind::city, night,
                                    {.sky = dvec3(sky_lux), .lamps = lamps, .air_light = {}});
  };
  const shared::GpuHorizon dark = land(dvec3(0.0), 0.4), lit = land(lux, 0.4), day = land(lux, 400.0);
  EXPECT_EQ(dark.lamps, vec3(0.0f));
  EXPECT_EQ(dark.lit, 0.0f);
  EXPECT_GT(lit.lit, 0.0f);
  for (int c = 0; c < 3; ++c) EXPECT_NEAR(lit.lamps[c] * pi, lux[c] * (1.0 - 0.4 / 400.0), 1e-4);
  EXPECT_EQ(day.lamps, vec3(0.0f));
  EXPECT_EQ(day.lit, 0.0f);
}

/// A cloud over the horizon is a step by azimuth. The air below is the light of many clouds.
TEST(Horizon, CloudsDoNotStripeTheAir) {
  render::Lighting lighting = plain_light(20.0, 25.0);
  lighting.clouds = 0.4;
  const render::Sky sky(lighting, false, true);
  double roughest = 0.0, bare = 0.0;
  const auto smooth = render::air_light_of(sky, true), striped = render::air_light_of(sky, false);
  for (size_t i = 0; i < smooth.size(); ++i) {
    const size_t next = (i + 1) % smooth.size();
    const auto step = [&](const auto& light) {
      return std::abs(std::log(render::luminance(light[next]) / render::luminance(light[i])));
    };
    roughest = std::max(roughest, step(smooth));
    bare = std::max(bare, step(striped));
  }
  EXPECT_LT(roughest, 0.4 * bare) << bare;  // per 2.8 degrees
  EXPECT_GT(bare, 0.2);
}

TEST(Horizon, SuitsTheScene) {
  EXPECT_EQ(render::horizon_of(field()), HorizonKind::plain);
  TinyScene small;
  small.quad({-5, -5, 0}, {5, -5, 0}, {5, 5, 0}, {-5, 5, 0});
  EXPECT_EQ(render::horizon_of(small.build()), HorizonKind::none);
  TinyScene green;
  scene::Material grass;
  grass.pbr.base_color = vec4(0.07f, 0.12f, 0.03f, 1.0f);
  green.object("grass", 0, green.material_as(grass))
      .quad({-50, -50, 0}, {50, -50, 0}, {50, 50, 0}, {-50, 50, 0});
  EXPECT_EQ(render::horizon_of(green.build()), HorizonKind::country);
  scene::Scene town = [] {
    TinyScene tiny;
    tiny.object("ground").quad({-50, -50, 0}, {50, -50, 0}, {50, 50, 0}, {-50, 50, 0});
    tiny.object("house").box({-20, -20, 0}, {20, 20, 12});
    return tiny.build();
  }();
  town.instances[1].semantic_class = scene::SemanticClass::building;
  EXPECT_EQ(render::horizon_of(town), HorizonKind::city);
  EXPECT_NEAR(render::land_height(town), 0.0, 1e-4);
  EXPECT_NEAR(render::land_height(field()), 2.0, 1e-4);
}

/// Houses and trees up to the border leave only the ends of four streets free: a sixth of it.
TEST(Horizon, LiesAtTheHeightOfStreetsThatEndBetweenHouses) {
  TinyScene tiny;
  tiny.object("ground").quad({-150, -150, 0}, {150, -150, 0}, {150, 150, 0}, {-150, 150, 0});
  for (const double x : {-1.0, 1.0})
    for (const double y : {-1.0, 1.0}) {
      const dvec2 inner(25.0 * x, 25.0 * y), outer(150.0 * x, 150.0 * y);
      tiny.object("block").box({std::min(inner.x, outer.x), std::min(inner.y, outer.y), 0},
                               {std::max(inner.x, outer.x), std::max(inner.y, outer.y), 18});
    }
  EXPECT_NEAR(render::land_height(tiny.build()), 0.0, 1e-4);
}

}  // namespace
}  // namespace greatx::test
