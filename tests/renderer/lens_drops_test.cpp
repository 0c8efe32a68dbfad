// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Holds drops on the glass before a lens against closed forms.
#include "renderer/camera/lens_drops.h"

#include <cmath>

#include <gtest/gtest.h>

#include "tests/renderer/camera_rig.h"

namespace greatx::test {
namespace {

TEST(LensDrops, CapsKeepTheVolumeOfTheDrop) {
  // A half-ball and a thin cap, whose volume is pi r^3 angle / 4.
  EXPECT_NEAR(render::cap_radius(2.0, 0.5 * pi), 2.0 / std::cbrt(4.0), 1e-12);
  const double angle = 0.01, r = render::cap_radius(1.0, angle);
  EXPECT_NEAR(pi * r * r * r * angle / 4.0 / (pi / 6.0), 1.0, 1e-3);
}

TEST(LensDrops, SizesAreThoseOfTheDropsThatFall) {
  for (const double rain : {1.0, 10.0, 50.0}) {
    const render::FallenDrops fallen(rain);
    EXPECT_NEAR(fallen.diameter(0.0), 0.5e-3, 1e-9);
    EXPECT_NEAR(fallen.diameter(1.0), 5e-3, 1e-9);
    const double slope = 4.1 * std::pow(rain, -0.21);
    const auto flux = [&](double mm) { return std::exp(-slope * mm) * (9.65 - 10.3 * std::exp(-0.6 * mm)); };
    double all = 0.0, small = 0.0, square = 0.0;
    for (int i = 0; i < 45000; ++i) {
      const double mm = 0.5 + (i + 0.5) * 1e-4;
      all += flux(mm);
      small += mm < 1.5 ? flux(mm) : 0.0;
      square += flux(mm) * mm * mm;
    }
    EXPECT_NEAR(fallen.diameter(small / all), 1.5e-3, 2e-6);
    EXPECT_NEAR(fallen.mean_square() / (1e-6 * square / all), 1.0, 1e-4);
  }
}

/// A thin cap is a prism that turns a ray by (n - 1) times its slope, towards the thick side. Along the axis
/// of any cap a ray goes straight, and both faces pass 2 % less each.
TEST(LensDrops, BendLightByTheLawOfRefraction) {
  const shared::DropWay axis =
      shared::way_through_drop({0, 0}, 1e-3f, float(std::cos(radians(40.0))), {0, 0, 1});
  EXPECT_NEAR(axis.direction.z, 1.0, 1e-6);
  const double face = 1.0 - std::pow((shared::water_index - 1.0) / (shared::water_index + 1.0), 2.0);
  EXPECT_NEAR(axis.share, face * face, 1e-6);
  const double contact = radians(2.0);
  for (const double at : {-0.8, 0.3, 0.9}) {
    const shared::DropWay way =
        shared::way_through_drop({float(at * 1e-3), 0}, 1e-3f, float(std::cos(contact)), {0, 0, 1});
    const double slope = std::asin(at * std::sin(contact));
    EXPECT_NEAR(way.direction.x, -(double(shared::water_index) - 1.0) * slope, 2e-5) << at;
  }
  // A ball's surface: the normal at `at` is known, and Snell's law bends the ray there.
  const double wide = radians(40.0), at = 0.7, inner = std::asin(at * std::sin(wide));
  const shared::DropWay way =
      shared::way_through_drop({float(at * 1e-3), 0}, 1e-3f, float(std::cos(wide)), {0, 0, 1});
  const double turned = std::asin(double(shared::water_index) * std::sin(inner)) - inner;
  EXPECT_NEAR(way.direction.x, -std::sin(turned), 1e-5);
  EXPECT_NEAR(glm::length(way.direction), 1.0, 1e-5);
  // Beyond the critical angle of 48.6 degrees the surface reflects all.
  EXPECT_EQ(shared::way_through_drop({0.99e-3f, 0}, 1e-3f, float(std::cos(radians(60.0))), {0, 0, 1}).share,
            0.0f);
}

TEST(LensDrops, CoverWhatTheyShallAndStayWhereTheyFell) {
  render::LensDrops drops;
  drops.coverage = 0.15;
  drops.rain_mm_h = 10.0;
  const render::FallenDrops fallen(drops.rain_mm_h);
  const dvec2 corner(0.5, 0.4);
  double covered = 0.0;
  constexpr int times = 20;
  for (int k = 0; k < times; ++k)
    for (const render::GlassDrop& drop :
         drops_on_glass(drops, fallen, {.seed = 3}, 0, 2.7 * k, -corner, corner))
      covered += pi * drop.radius * drop.radius / times;
  // Drops whose middles lie outside make 2 % more.
  EXPECT_NEAR(covered / (4.0 * corner.x * corner.y), 0.15, 0.008);

  const auto at = [&](double time, uint64_t seed = 3) {
    return drops_on_glass(drops, fallen, {.seed = seed}, 0, time, {-0.02, -0.02}, {0.02, 0.02});
  };
  const std::vector<render::GlassDrop> before = at(5.0), after = at(5.05), other = at(5.0, 4);
  ASSERT_GT(before.size(), 10u);
  size_t same = 0, moved = 0;
  for (const render::GlassDrop& a : before)
    for (const render::GlassDrop& b : after) {
      same += a.middle == b.middle && a.radius == b.radius;
      const dvec2 way = b.middle - a.middle;
      moved += way.x == 0.0 && way.y > 0.0 && way.y < 2e-3 && b.radius < a.radius;
    }
  EXPECT_GT(same, before.size() / 2);
  EXPECT_GT(moved, 0u);
  EXPECT_NE(before[0].middle, other[0].middle);
}

/// Behind drops an even picture loses what the faces of the water reflect, and nothing else. Pixels without
/// drops keep their bytes.
TEST(LensDrops, AnEvenPictureLosesOnlyWhatWaterReflects) {
  TinyScene tiny;
  scene::Material glow = optical_material("glow", 0.0f);
  glow.pbr.emissive = vec3(2.0f);
  tiny.object("screen", 0, tiny.material_as(glow))
      .quad({5, 99, -99}, {5, -99, -99}, {5, -99, 99}, {5, 99, 99});
  const scene::Scene scene = tiny.build();
  render::CameraEffects effects = lambertian();
  effects.sun = effects.sky = false;
  render::CameraDesc desc = plain_camera(128);
  desc.fx = desc.fy = 512.0;  // no ray is steep enough to be reflected wholly
  CameraRig clean(scene, plain_light(), desc, effects);
  desc.drops.coverage = 0.3;
  desc.drops.contact_deg = 30.0;
  desc.drops.glass_m = 0.2;
  CameraRig wet(scene, plain_light(), desc, effects), again(scene, plain_light(), desc, effects);
  const Pose sensor = look({0, 0, 0});
  const render::CameraImages without = clean.shoot(sensor), with = wet.shoot(sensor);
  EXPECT_EQ(with.hdr, again.shoot(sensor).hdr);
  EXPECT_EQ(with.depth, without.depth);
  size_t dry = 0, lost = 0;
  for (size_t i = 0; i < size_t{128} * 128; ++i) {
    const double share = luminance_at(with, i) / luminance_at(without, i);
    EXPECT_LE(share, 1.001);
    EXPECT_GE(share, 0.92);
    dry += share == 1.0;
    lost += share < 0.98;
  }
  EXPECT_GT(dry, 1000u);
  EXPECT_GT(lost, 1000u);
}

/// A drop shows the picture the other way round: light from the left stands on its right.
TEST(LensDrops, TurnThePictureRound) {
  TinyScene tiny;
  scene::Material glow = optical_material("glow", 0.0f);
  glow.pbr.emissive = vec3(2.0f);
  tiny.object("left half", 0, tiny.material_as(glow))
      .quad({5, 99, -99}, {5, 0, -99}, {5, 0, 99}, {5, 99, 99});
  render::CameraEffects effects = lambertian();
  effects.sun = effects.sky = false;
  render::CameraDesc desc = plain_camera(128);
  desc.drops.coverage = 0.4;
  desc.drops.aperture_m = 0.0;
  desc.drops.glass_m = 0.02;
  CameraRig wet(tiny.build(), plain_light(), desc, effects);
  const render::CameraImages images = wet.shoot(look({0, 0, 0}));
  size_t right = 0, dark_left = 0;
  for (uint32_t row = 0; row < 128; ++row)
    for (uint32_t column = 0; column < 128; ++column) {
      const double seen = luminance_at(images, size_t{row} * 128 + column);
      right += column > 68 && seen > 1000.0;
      dark_left += column < 60 && seen < 200.0;
    }
  EXPECT_GT(right, 20u);
  EXPECT_GT(dark_left, 20u);
}

}  // namespace
}  // namespace greatx::test
