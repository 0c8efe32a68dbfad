// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Checks the shadows of spots that move: against geometry, and that their choice neither jumps nor remembers.
#include "renderer/light/beam_shadow.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <string>

#include <gtest/gtest.h>

#include "renderer/camera/camera_view.h"
#include "shaders/shared/beam.h"
#include "tests/renderer/camera_rig.h"

namespace greatx::test {
namespace {

/// Returns a head lamp of body 1 that shines along the body's x.
scene::PunctualLight head_lamp(uint32_t body, double aside) {
  scene::PunctualLight lamp;
  lamp.name = "head lamp";
  lamp.type = scene::PunctualLight::Type::spot;
  lamp.beam = scene::PunctualLight::Beam::passing;
  lamp.position = {0.0, aside, 0.0};
  lamp.direction = glm::normalize(dvec3(1.0, 0.0, -0.01));
  lamp.intensity = 12000.0f;
  lamp.range_m = 200.0f;
  lamp.inner_cone = float(radians(20.0));
  lamp.outer_cone = float(radians(35.0));
  lamp.body = body;
  return lamp;
}

render::CameraEffects by_lamps() {
  render::CameraEffects effects = lambertian();
  effects.sun = effects.sky = false;
  effects.lamp_shadows = true;
  return effects;
}

/// Returns the illuminance of a wall across x by a lamp at `from`, lux.
double illuminance(const scene::PunctualLight& lamp, const dvec3& from, const dvec3& p) {
  const dvec3 way = p - from;
  const double d = glm::length(way), cone = glm::dot(way / d, lamp.direction);
  const double inner = std::cos(double(lamp.inner_cone)), outer = std::cos(double(lamp.outer_cone));
  const double ramp = std::clamp((cone - outer) / (inner - outer), 0.0, 1.0);
  double share = ramp * ramp * (1.0 - std::pow(d / double(lamp.range_m), 4.0));
  if (lamp.beam == scene::PunctualLight::Beam::passing) {
    const render::BeamAxes axes = render::beam_axes(lamp, Pose{});
    const double along = glm::dot(way, axes.along);
    share *= double(shared::passing_beam(float(glm::dot(way, axes.right) / along),
                                         float(glm::dot(way, axes.up) / along)));
  }
  return double(lamp.intensity) * share * (way.x / d) / (d * d);
}

TEST(BeamShadow, OfAPlateBeforeTwoHeadLampsFallsWhereGeometrySays) {
  // A plate 10 m before a car hides a wall 20 m before it from its lamps, 1.4 m apart: each casts a shadow
  // twice as wide as the plate, and the two are 1.4 m apart again.
  const dvec3 low(10.0, -0.5, -1.5), high(10.02, 0.5, 0.4);
  for (const bool moving : {false, true})
    for (const bool beam : {true, false}) {
      TinyScene tiny;
      const uint32_t car = tiny.body("car"), plate = moving ? tiny.body("plate") : 0;
      tiny.object("wall", 0, tiny.material_as(optical_material("white", 0.8f)))
          .quad({20, 9, -6}, {20, -9, -6}, {20, -9, 6}, {20, 9, 6});
      // The car's own bumper stands before its lamps and hides nothing.
      tiny.object("car", car).box({0.6, -1, -1}, {0.7, 1, 1});
      tiny.object("plate", plate).box(low, high);
      scene::Scene scene = tiny.build();
      scene.lights = {head_lamp(car, 0.7), head_lamp(car, -0.7)};
      if (!beam)
        for (scene::PunctualLight& lamp : scene.lights) lamp.beam = scene::PunctualLight::Beam::cone;
      const std::vector<scene::PunctualLight> lamps = scene.lights;
      render::CameraDesc desc = plain_camera(240, 1);
      desc.exposure_ev100 = 5.0;
      CameraRig rig(std::move(scene), plain_light(), desc, by_lamps());
      const Pose sensor = look({12, 0, 0});
      const Pose aside{{0.0, 0.3, 0.0}, {1, 0, 0, 0}};
      std::vector<Pose> bodies{Pose{}};
      if (moving) bodies.push_back(aside);
      const dvec3 shift = moving ? aside.position : dvec3(0.0);
      const render::CameraImages images = rig.shoot(sensor, bodies);
      const double half = beam ? double(shared::beam_tile_right) : std::tan(radians(35.0));
      const double texel = 20.0 * 2.0 * half / shared::beam_tile_width;  // on the wall
      const double tall = beam ? texel : 20.0 * 2.0 * half / shared::beam_tile_height;
      const auto blocked = [&](const dvec3& from, const dvec3& p, double across, double up) {
        const dvec3 at = from + (p - from) * ((10.0 - from.x) / (p.x - from.x)) - shift;
        return at.y > low.y - across && at.y < high.y + across && at.z > low.z - up && at.z < high.z + up;
      };
      std::array<size_t, 3> seen{};
      for (uint32_t row = 0; row < desc.height; ++row)
        for (uint32_t column = 0; column < desc.width; ++column) {
          const size_t i = size_t(row) * desc.width + column;
          if (images.instance[i] != 1) continue;
          const dvec3 p = sensor.apply(pixel_ray(desc, column, row) * double(images.depth[i]));
          double expected = 0.0;
          int hidden = 0;
          bool sure = true;
          for (const scene::PunctualLight& lamp : lamps) {
            // An edge lies within 1.5 texels: of the plate's, which is half as far away.
            const bool surely = blocked(lamp.position, p, -0.75 * texel, -0.75 * tall),
                       maybe = blocked(lamp.position, p, 0.75 * texel, 0.75 * tall);
            sure &= surely == maybe;
            hidden += surely;
            if (!surely) expected += 0.8 / pi * illuminance(lamp, lamp.position, p);
          }
          if (!sure) continue;
          ++seen[size_t(hidden)];
          EXPECT_NEAR(luminance_at(images, i), expected, 3e-3 * expected + 2e-3)
              << p.y << " " << p.z << " " << moving << beam;
        }
      EXPECT_GT(seen[0], 8000u);
      EXPECT_GT(seen[1], 500u) << "half shadow";
      EXPECT_GT(seen[2], 100u) << "umbra";
    }
}

/// A street with cars, one behind the other; the lamps shine along x.
scene::Scene street_of(uint32_t cars) {
  TinyScene tiny;
  std::vector<uint32_t> bodies;
  for (uint32_t i = 0; i < cars; ++i) bodies.push_back(tiny.body("car" + std::to_string(i)));
  tiny.object("ground").quad({-100, -30, -0.7}, {100, -30, -0.7}, {100, 30, -0.7}, {-100, 30, -0.7});
  tiny.object("post").box({6, -0.2, -0.7}, {6.2, 0.2, 2.0});
  for (const uint32_t body : bodies) tiny.object("car", body).box({-3, -1, -0.7}, {0, 1, 0.8});
  scene::Scene scene = tiny.build();
  for (const uint32_t body : bodies) {
    scene.lights.push_back(head_lamp(body, 0.7));
    scene.lights.push_back(head_lamp(body, -0.7));
  }
  return scene;
}

/// Returns the poses of the cars, without that of the static world.
std::vector<Pose> placed(uint32_t cars, double first) {
  std::vector<Pose> poses;
  for (uint32_t i = 0; i < cars; ++i) poses.push_back({{first - 13.0 * i, i % 2 * 4.0, 0.0}, {1, 0, 0, 0}});
  return poses;
}

std::vector<render::BeamTile> chosen(const render::BeamShadows& shadows, std::vector<Pose> poses,
                                     const Pose& sensor) {
  poses.insert(poses.begin(), Pose{});
  const render::CameraView view(render::pinhole_of(plain_camera()), 0.1, sensor,
                                render::SunFrame::of({0, 0, 1}), 1.0);
  return shadows.choose(
      poses, {view.eye, [&](const dvec3& center, double radius) { return view.share(center, radius); }});
}

TEST(BeamShadow, StrengthsDoNotJumpWhenBodiesGainAndLoseTheirTiles) {
  constexpr uint32_t cars = 9;
  const scene::Scene scene = street_of(cars);
  const scene::GpuScene gpu(device(), scene, {.acceleration_structure = false, .textures = true});
  const render::BeamShadows shadows(gpu, {.wanted = true, .alpha_mask = true});
  ASSERT_TRUE(shadows.any());
  std::vector<double> last;
  size_t gained = 0, lost = 0;
  double most = 0.0;
  for (int step = 0; step <= 4000; ++step) {  // of 2.5 cm
    const std::vector<render::BeamTile> tiles =
        chosen(shadows, placed(cars, -20.0 + 0.025 * step), look({30, -3, 2}, 180.0));
    EXPECT_LE(tiles.size(), render::most_beam_tiles);
    std::vector<double> now(2 * size_t{cars}, 0.0);
    for (const render::BeamTile& tile : tiles) now[tile.light] = tile.strength;
    for (size_t i = 0; step > 0 && i < now.size(); ++i) {
      most = std::max(most, std::abs(now[i] - last[i]));
      gained += last[i] == 0.0 && now[i] > 0.0;
      lost += last[i] > 0.0 && now[i] == 0.0;
    }
    last = now;
  }
  EXPECT_GE(gained, 4u);
  EXPECT_GE(lost, 4u);
  // Scores change by a few per cent a metre, so strengths change by a few per cent in 2.5 cm.
  EXPECT_LT(most, 0.05);
}

TEST(BeamShadow, APictureDependsOnNoTickBefore) {
  constexpr uint32_t cars = 6;
  render::CameraDesc desc = plain_camera(96, 1);
  desc.exposure_ev100 = 5.0;
  const Pose from = look({0, -8, 6}, 90.0, 35.0);
  CameraRig moved(street_of(cars), plain_light(), desc, by_lamps());
  for (const double first : {-30.0, 0.0, 40.0}) moved.shoot(from, placed(cars, first));
  const std::vector<Pose> poses = placed(cars, 14.0);
  const render::CameraImages after = moved.shoot(from, poses);
  CameraRig fresh(street_of(cars), plain_light(), desc, by_lamps());
  const render::CameraImages first = fresh.shoot(from, poses);
  EXPECT_EQ(after.hdr, first.hdr);
  render::CameraEffects without = by_lamps();
  without.beam_shadows = false;
  CameraRig open(street_of(cars), plain_light(), desc, without);
  EXPECT_NE(open.shoot(from, poses).hdr, first.hdr) << "the post casts a shadow";
}

TEST(BeamShadow, CamerasDoNotDisturbEachOther) {
  constexpr uint32_t cars = 6;
  render::CameraDesc desc = plain_camera(96, 1);
  desc.exposure_ev100 = 5.0;
  const Pose here = look({0, -8, 6}, 90.0, 35.0);
  const std::vector<Pose> poses = placed(cars, 14.0);
  CameraRig alone(street_of(cars), plain_light(), desc, by_lamps()),
      among(street_of(cars), plain_light(), desc, by_lamps());
  // The others see other lamps: tiles are theirs alone.
  const std::array<Pose, 2> others{look({40, -8, 6}, 100.0, 30.0), look({-30, 8, 5}, -80.0, 40.0)};
  EXPECT_EQ(among.shoot_among(others, here, poses).hdr, alone.shoot(here, poses).hdr);
}

TEST(BeamShadow, NothingIsChosenWhereNoBeamLightsThePicture) {
  const scene::Scene scene = street_of(1);
  const scene::GpuScene gpu(device(), scene, {.acceleration_structure = false, .textures = true});
  const render::BeamShadows shadows(gpu, {.wanted = true, .alpha_mask = true});
  EXPECT_TRUE(chosen(shadows, placed(1, 0.0), look({60, 0, 2})).empty());
  EXPECT_EQ(chosen(shadows, placed(1, 0.0), look({-20, 0, 2})).size(), 2u);
  EXPECT_FALSE(render::BeamShadows(gpu, {}).any());
}

}  // namespace
}  // namespace greatx::test
