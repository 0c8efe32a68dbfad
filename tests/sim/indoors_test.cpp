// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Tests that a closed room is lit by its own lamps, and how bright they make it.
#include "sim/plan/indoors.h"

#include <cmath>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "sim/plan/plan_options.h"
#include "sim/scenario/parse/load_scenario.h"
#include "tests/renderer/camera_rig.h"

namespace greatx::sim {
namespace {

using test::TinyScene;

constexpr double albedo = 0.5, candelas = 900.0;
constexpr dvec3 room_low(-6.0, -4.0, 0.0), room_high(6.0, 4.0, 3.2);
constexpr dvec3 lamps[] = {{-3.0, 0.0, 3.0}, {3.0, 1.0, 3.0}};

/// Returns a room of one grey, with two lamps that shine evenly into all directions, and an outer world.
scene::Scene room(bool with_ceiling) {
  TinyScene tiny;
  const uint32_t grey = tiny.material_as(test::optical_material("grey", float(albedo)));
  const dvec3 a = room_low, b = room_high;
  tiny.object("room", 0, grey)
      .quad({a.x, a.y, a.z}, {b.x, a.y, a.z}, {b.x, b.y, a.z}, {a.x, b.y, a.z})
      .quad({a.x, a.y, a.z}, {a.x, b.y, a.z}, {a.x, b.y, b.z}, {a.x, a.y, b.z})
      .quad({b.x, a.y, a.z}, {b.x, a.y, b.z}, {b.x, b.y, b.z}, {b.x, b.y, a.z})
      .quad({a.x, a.y, a.z}, {a.x, a.y, b.z}, {b.x, a.y, b.z}, {b.x, a.y, a.z})
      .quad({a.x, b.y, a.z}, {b.x, b.y, a.z}, {b.x, b.y, b.z}, {a.x, b.y, b.z});
  if (with_ceiling) tiny.quad({a.x, a.y, b.z}, {a.x, b.y, b.z}, {b.x, b.y, b.z}, {b.x, a.y, b.z});
  scene::Scene scene = tiny.build();
  for (const dvec3& place : lamps) {
    scene::PunctualLight lamp;
    lamp.name = fmt::format("lamp {}", scene.lights.size());
    lamp.position = place;
    lamp.intensity = float(candelas);
    scene.lights.push_back(lamp);
  }
  return scene;
}

Scenario scenario_with(const std::string& sensor) {
  return parse_scenario(
      "greatx: 1\nname: room\nticks: 1\ntick_rate_hz: 10\n"
      "environment: {sun: {azimuth_deg: 0, elevation_deg: 40}, rain_mm_h: 5}\nnodes:\n"
      "  - name: rig\n    trajectory: {type: static, position_m: [0, 0, 1.2]}\n    sensors:\n      - " +
          sensor,
      "room.yaml", ".");
}

const char* const camera =
    "{name: eye, type: camera, rate_hz: 10, width: 32, height: 32, fov_deg: 90, outputs: [hdr]}\n";

TEST(Indoors, AreWhereNoDirectionLeadsOut) {
  EXPECT_TRUE(indoors_of(scenario_with(camera), room(true)));
  EXPECT_FALSE(indoors_of(scenario_with(camera), room(false)));
  EXPECT_FALSE(indoors_of(scenario_with("{name: radio, type: antenna}\n"), room(true)));
  Scenario outside = scenario_with(camera);
  std::get<StaticTrajectory>(outside.nodes[0].trajectory).position_m = {0.0, 9.0, 1.0};
  EXPECT_FALSE(indoors_of(outside, room(true)));
}

TEST(Indoors, ReflectedLightIsThatOfASphere) {
  const Indoors light = *indoors_of(scenario_with(camera), room(true));
  EXPECT_NEAR(light.lamps_lm, 2.0 * 4.0 * pi * candelas, 1.0);
  EXPECT_NEAR(light.area_m2, 2.0 * (12.0 * 8.0 + 12.0 * 3.2 + 8.0 * 3.2), 1e-3);
  EXPECT_NEAR(light.albedo, albedo, 1e-6);
  // Half of the flux is reflected at each meeting: 1/2 + 1/4 + ... = 1 of it.
  EXPECT_NEAR(light.indirect_lux, light.lamps_lm / light.area_m2, 1e-3);
}

TEST(Indoors, ThePictureHasTheLampsAndTheirReflectedLightAlone) {
  const Scenario scenario = scenario_with(camera);
  const scene::Scene scene = room(true);
  const EffectPlan plan = make_effect_plan(scenario, scene);
  ASSERT_TRUE(plan.indoors);
  EXPECT_FALSE(plan.sun.on || plan.haze.on || plan.wet_surfaces.on || plan.rain_streaks.on ||
               plan.night_sky.on);
  EXPECT_TRUE(plan.punctual_lights.on && plan.lamp_shadows.on);
  render::CameraEffects effects = camera_effects(plan);
  effects.specular = false;
  render::CameraDesc desc = test::plain_camera(32, 1);
  desc.exposure_ev100 = 8.0;
  const double reflected = plan.indoors->indirect_lux;
  test::CameraRig rig(scene, lighting_of(scenario.environment, plan), desc, effects);
  const Pose sensor = test::look({0, 0, 1.2}, 0.0, 90.0);
  const render::CameraImages images = rig.shoot(sensor);
  for (uint32_t row = 0; row < desc.height; ++row)
    for (uint32_t column = 0; column < desc.width; ++column) {
      const size_t i = size_t(row) * desc.width + column;
      const dvec3 p = sensor.apply(test::pixel_ray(desc, column, row) * double(images.depth[i]));
      ASSERT_NEAR(p.z, 0.0, 1e-3);  // the floor
      double lux = reflected;
      for (const dvec3& lamp : lamps) {
        const dvec3 way = lamp - p;
        lux += candelas * way.z / std::pow(glm::length(way), 3.0);  // E = I cos / d^2
      }
      EXPECT_NEAR(test::luminance_at(images, i) / (albedo / pi * lux), 1.0, 5e-3) << p.x << " " << p.y;
    }
}

}  // namespace
}  // namespace greatx::sim
