// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Holds the sunlight that maps of shadows let through panes against closed forms and the path-traced
// reference.
#include <cmath>

#include <gtest/gtest.h>

#include "renderer/reference/path_tracer.h"
#include "renderer/surface/closed_bodies.h"
#include "renderer/surface/pane_color.h"
#include "shaders/shared/pane.h"
#include "tests/renderer/camera_rig.h"

namespace greatx::test {
namespace {

scene::Material shading_glass(const vec3& color) {
  scene::Material material;
  material.name = "glass";
  material.pbr.base_color = vec4(color, 1.0f);
  material.pbr.metallic = 0.0f;
  material.pbr.roughness = 0.05f;
  material.pbr.transmission = 1.0f;
  return material;
}

render::CameraEffects effects_with(bool panes, bool cascades = false) {
  render::CameraEffects effects = lambertian();
  effects.sky = false;
  effects.panes = panes;
  effects.shadow_cascades = cascades;
  return effects;
}

constexpr double ground_half_m = 10.0, pane_half_m = 2.5, pane_z_m = 2.0;

void add_ground(TinyScene& tiny) {
  constexpr double g = ground_half_m;
  tiny.object("ground", 0, tiny.material_as(optical_material("ground", 0.5f)))
      .quad({-g, -g, 0}, {g, -g, 0}, {g, g, 0}, {-g, g, 0});
}

/// Ground, and a level pane 2 m above its middle, which belongs to a body that moves or does not.
scene::Scene under_glass(const vec3& color, bool moves) {
  TinyScene tiny;
  add_ground(tiny);
  const uint32_t body = moves ? tiny.body("pane") : 0;
  constexpr double p = pane_half_m;
  tiny.object("pane", body, tiny.material_as(shading_glass(color)))
      .quad({-p, -p, pane_z_m}, {p, -p, pane_z_m}, {p, p, pane_z_m}, {-p, p, pane_z_m});
  return tiny.build();
}

double lit(const render::Lighting& light) {
  return 0.5 / pi * light.sun_illuminance_lux * light.sun_direction.z;
}

/// Returns the least and the largest share of the sunlight on the ground well within the shadow of the pane.
dvec2 shares(const render::CameraImages& images, const render::CameraDesc& desc, const Pose& sensor,
             const render::Lighting& light) {
  dvec2 found(1e9, -1e9);
  for (uint32_t row = 0; row < desc.height; ++row)
    for (uint32_t column = 0; column < desc.width; ++column) {
      const size_t i = size_t(row) * desc.width + column;
      if (images.instance[i] != 1) continue;
      const dvec3 p = sensor.apply(pixel_ray(desc, column, row) * double(images.depth[i]));
      const dvec2 under = glm::abs(dvec2(p + light.sun_direction * (pane_z_m / light.sun_direction.z)));
      if (std::max(under.x, under.y) > pane_half_m - 0.3) continue;
      const double share = luminance_at(images, i) / lit(light);
      found = {std::min(found.x, share), std::max(found.y, share)};
    }
  return found;
}

TEST(PaneShadows, QuartersAreWithinAnEighthOfWhatPasses) {
  for (const double gray : {0.02, 0.2, 0.4, 0.6, 0.8, 0.95, 1.0})
    for (const double cosine : {1.0, 0.8, 0.5, 0.2, 0.05, 0.0}) {
      const uint32_t filled = shared::pane_filled_quarters(vec3(float(gray)), float(cosine));
      const double passes =
          gray * (1.0 - double(shared::pane_reflectance(float(cosine), shared::pane_index, 1.0f)));
      ASSERT_LE(filled, 4u);
      EXPECT_LE(std::abs(1.0 - 0.25 * filled - passes), 0.125 + 1e-6) << gray << ", " << cosine;
    }
}

/// The light is even: neither the texels nor the size of the pixels show.
TEST(PaneShadows, LetTheSunThroughByQuarters) {
  struct Case {
    bool moves, cascades;
    double gray, elevation_deg;
  };
  for (const Case& c :
       {Case{false, false, 0.3, 90.0}, Case{false, false, 0.8, 47.0}, Case{false, true, 0.6, 47.0},
        Case{true, false, 0.8, 90.0}, Case{true, false, 0.3, 47.0}, Case{true, false, 1.0, 47.0}}) {
    const render::Lighting light = plain_light(30.0, c.elevation_deg);
    const auto cosine = float(light.sun_direction.z);
    const double passes = c.gray * (1.0 - double(shared::pane_reflectance(cosine, shared::pane_index, 1.0f)));
    const double expected = 1.0 - 0.25 * shared::pane_filled_quarters(vec3(float(c.gray)), cosine);
    for (const uint32_t size : {32u, 256u}) {
      const render::CameraDesc desc = plain_camera(size);
      const Pose sensor = look({-1.0, 0.3, 1.9}, 10.0, 50.0);
      CameraRig rig(under_glass(vec3(float(c.gray)), c.moves), light, desc, effects_with(true, c.cascades));
      const render::CameraImages images = rig.shoot(sensor, std::vector<Pose>(c.moves ? 1 : 0));
      const dvec2 inside = shares(images, desc, sensor, light);
      EXPECT_NEAR(inside.x, expected, 4e-3) << c.gray << ' ' << c.elevation_deg << ' ' << size;
      EXPECT_NEAR(inside.y, expected, 4e-3) << c.gray << ' ' << c.elevation_deg << ' ' << size;
      EXPECT_NEAR(inside.x, passes, 0.125 + 4e-3);
    }
  }
}

TEST(PaneShadows, AreThoseOfSolidsWithoutTheEffect) {
  const render::Lighting light = plain_light(30.0, 60.0);
  const render::CameraDesc desc = plain_camera(64);
  const Pose sensor = look({-1.0, 0.3, 1.9}, 10.0, 50.0);
  CameraRig rig(under_glass(vec3(1.0f), false), light, desc, effects_with(false));
  const dvec2 inside = shares(rig.shoot(sensor), desc, sensor, light);
  EXPECT_LT(inside.y, 1e-3);
}

/// The sun shines through the roof of a closed body onto its floor, and not through its walls.
TEST(PaneShadows, TheSunShinesIntoBodies) {
  TinyScene tiny;
  add_ground(tiny);
  const uint32_t car = tiny.body("car");
  const uint32_t paint = tiny.material_as(optical_material("paint", 0.5f));
  tiny.object("car", car, paint).open_box({-2, -1, 0.3}, {2, 1, 1.5});
  tiny.object("roof", car, tiny.material_as(shading_glass(vec3(0.8f))))
      .quad({-2, -1, 1.5}, {2, -1, 1.5}, {2, 1, 1.5}, {-2, 1, 1.5});
  const scene::Scene scene = tiny.build();
  ASSERT_TRUE(render::closed_bodies(scene)[car]);
  const render::Lighting light = plain_light(90.0, 70.0);
  CameraRig rig(scene, light, plain_camera(128), effects_with(true));
  const Pose sensor = look({0, 0, 1.4}, 90.0, 89.0);
  const render::CameraImages images = rig.shoot(sensor, {Pose{}});
  const auto share = [&](double y) {  // of the floor, 1.1 m below the eye
    const auto row = static_cast<uint32_t>(64.0 - 64.0 * y / 1.1);
    return luminance_at(images, size_t(row) * 128 + 64) / lit(light);
  };
  EXPECT_NEAR(share(-0.5), 0.75, 0.01);
  EXPECT_NEAR(share(0.2), 0.75, 0.01);
  EXPECT_LT(share(0.85), 0.01);  // in the shadow of the wall towards the sun, which reaches 0.44 m
}

/// One clear pane holds off an eighth of the sun's light at most; the reference knows its transmittance.
TEST(PaneShadows, AreWithinAnEighthOfTheReference) {
  const render::Lighting light = plain_light(30.0, 50.0);
  const render::CameraEffects effects = effects_with(true);
  for (const double gray : {0.5, 0.79, 0.92}) {
    const scene::Scene scene = under_glass(vec3(float(gray)), false);
    const std::vector<Pose> poses(1);
    const render::PathTracer tracer(scene, poses, light, effects, {.bounces = 0});
    const Pose sensor = look({-1.0, 0.3, 1.9}, 10.0, 50.0);
    const render::CameraDesc desc = plain_camera(64);
    CameraRig rig(scene, light, desc, effects);
    const render::CameraImages images = rig.shoot(sensor);
    double sum = 0.0;
    constexpr int paths = 4000;
    const dvec3 ray = glm::normalize(sensor.rotate(pixel_ray(desc, 32, 32)));
    for (int i = 0; i < paths; ++i) {
      render::PathDraws draws(7, 1, uint32_t(i));
      sum += render::luminance(tracer.trace({sensor.position, ray}, 0.0, draws).radiance) / paths;
    }
    const double passes =
        gray *
        (1.0 - double(shared::pane_reflectance(float(light.sun_direction.z), shared::pane_index, 1.0f)));
    EXPECT_NEAR(sum / lit(light), passes, 0.02) << gray;
    EXPECT_NEAR(luminance_at(images, 32 * 64 + 32) / lit(light), sum / lit(light), 0.125 + 0.02) << gray;
  }
}

}  // namespace
}  // namespace greatx::test
