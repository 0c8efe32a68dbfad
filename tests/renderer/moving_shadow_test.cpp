// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "renderer/light/moving_shadow.h"

#include <cmath>
#include <cstring>
#include <set>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/random.h"
#include "renderer/light/shadow_grid.h"
#include "renderer/surface/closed_bodies.h"
#include "tests/renderer/camera_rig.h"

namespace greatx::test {
namespace {

/// Returns the tiles, by their uv, that a pixel at p would look at. The steps are those of light.glsl.
std::multiset<float> looked_at(const std::vector<uint32_t>& words, const vec2& p) {
  shared::ShadowTilesHeader header;
  std::memcpy(&header, words.data(), sizeof header);
  std::multiset<float> found;
  if (!(p.x > header.min.x && p.y > header.min.y && p.x < header.max.x && p.y < header.max.y)) return found;
  const vec2 at = glm::clamp(glm::floor((p - header.min) * header.cells_per_m), vec2(0.0f),
                             vec2(header.columns, header.rows) - 1.0f);
  const uint32_t cell = words[8 + size_t(at.y * header.columns + at.x)];
  for (uint32_t i = 0; i < (cell & shared::shadow_cell_most); ++i) {
    shared::GpuShadowTile tile;
    std::memcpy(&tile, &words[4 * size_t(cell >> shared::shadow_cell_bits) + 8 * size_t(i)], sizeof tile);
    found.insert(tile.uv_center.x);
  }
  return found;
}

TEST(ShadowGrid, APixelLooksAtEveryTileAroundItOnce) {
  RandomStream random(5, 1);
  for (const uint32_t count : {1u, 2u, 40u, 400u}) {
    std::vector<shared::GpuShadowTile> tiles(count);
    for (uint32_t i = 0; i < count; ++i) {
      tiles[i].center = vec3(random.uniform(-200, 300), random.uniform(-50, 90), random.uniform(0, 10));
      tiles[i].radius = float(std::exp(random.uniform(-2.0, i % 9 == 0 ? 4.0 : 1.5)));
      tiles[i].uv_center = vec2(float(i), 0.0f);
    }
    const std::vector<uint32_t> words = render::shadow_grid(tiles);
    size_t looks = 0;
    for (int k = 0; k < 4000; ++k) {
      // Half of the places lie within a tile, a quarter of them at its very rim.
      const shared::GpuShadowTile& aim = tiles[random.below(count)];
      const vec2 p = k % 2 == 0
                         ? vec2(random.uniform(-260, 360), random.uniform(-110, 150))
                         : vec2(aim.center) + aim.radius * vec2(k % 4 == 1 ? 0.9999 : random.uniform(-1, 1),
                                                                random.uniform(-1, 1));
      const std::multiset<float> found = looked_at(words, p);
      looks += found.size();
      for (uint32_t i = 0; i < count; ++i) {
        const vec2 away = glm::abs(p - vec2(tiles[i].center)) / tiles[i].radius;
        const bool within = std::max(away.x, away.y) < 1.0f;
        ASSERT_GE(found.count(float(i)), within ? 1u : 0u) << i << " of " << count;
        ASSERT_LE(found.count(float(i)), 1u);
      }
    }
    EXPECT_LE(looks, size_t{4000} * std::max(count / 6, 2u));
  }
}

TEST(ShadowGrid, NoTilesHaveNoPlaces) { EXPECT_TRUE(looked_at(render::shadow_grid({}), {0, 0}).empty()); }

/// Ground, and cars that are no cubes: a turn shows in their shadows.
struct Street {
  static constexpr int count = 12;
  TinyScene tiny;
  Street() {
    tiny.quad({-60, -60, 0}, {60, -60, 0}, {60, 60, 0}, {-60, 60, 0});
    for (int i = 0; i < count; ++i) {
      const uint32_t body = tiny.body("car " + std::to_string(i));
      tiny.object("car " + std::to_string(i), body)
          .box({-2, -0.8, 0}, {2, 0.8, 1})
          .box({-1, -0.7, 1}, {1, 0.7, 1.6});
    }
  }
  static std::vector<Pose> poses(double along, double turn) {
    std::vector<Pose> all;
    for (int i = 0; i < count; ++i)
      all.push_back({{-30.0 + 5.5 * i + along, i % 2 ? 3.0 : -3.0, 0.0},
                     orientation_from_yaw_pitch_roll(turn + 0.3 * i, 0, 0)});
    return all;
  }
};

TEST(MovingShadows, APictureDoesNotDependOnThoseBefore) {
  // Tiles stay as they are while bodies move without turning. The picture must be that of tiles drawn anew.
  const Street street;
  const Pose eye = look({-35, 8, 6}, -8.0, 14.0);
  CameraRig old(street.tiny.build(), plain_light(140.0, 30.0), plain_camera(96));
  for (const double along : {0.0, 1.3, 2.9}) old.shoot(eye, Street::poses(along, 0.0));
  old.shoot(look({-35, 8, 6}, 170.0, 14.0), Street::poses(4.0, 0.4));  // it sees few of them
  const render::CameraImages seen = old.shoot(eye, Street::poses(4.7, 0.4));
  CameraRig fresh(street.tiny.build(), plain_light(140.0, 30.0), plain_camera(96));
  const render::CameraImages anew = fresh.shoot(eye, Street::poses(4.7, 0.4));
  EXPECT_EQ(seen.hdr, anew.hdr);
  EXPECT_EQ(seen.depth, anew.depth);
  EXPECT_EQ(seen.instance, anew.instance);
  EXPECT_NE(seen.hdr, fresh.shoot(eye, Street::poses(4.7, 0.5)).hdr);
}

TEST(MovingShadows, OnlyWhatTurnsAndMayBeSeenIsDrawn) {
  const Street street;
  CameraRig rig(street.tiny.build(), plain_light(140.0, 30.0), plain_camera(64));
  const auto drawn = [&] { return rig.lighting().shadows().moving().drawn_tiles(); };
  const Pose all = look({0, 0, 70}, 0.0, 90.0), none = look({0, 0, 30}, 0.0, -60.0);
  rig.shoot(none, Street::poses(0.0, 0.0));
  EXPECT_EQ(drawn(), 0u);
  rig.shoot(all, Street::poses(0.0, 0.0));
  EXPECT_EQ(drawn(), 12u);
  rig.shoot(all, Street::poses(3.0, 0.0));
  EXPECT_EQ(drawn(), 12u);
  std::vector<Pose> one = Street::poses(3.0, 0.0);
  one[4].orientation = orientation_from_yaw_pitch_roll(1.0, 0, 0);
  rig.shoot(all, one);
  EXPECT_EQ(drawn(), 13u);
  // Looking along x, the camera sees the cars ahead alone.
  rig.shoot(look({10, 0, 4}, 0.0, 10.0), Street::poses(0.0, 1.0));
  EXPECT_GT(drawn(), 13u);
  EXPECT_LT(drawn(), 13u + 8u);
}

TEST(MovingShadows, WheelsThatTurnStandStillInTheirShadow) {
  // A wheel is a prism of 48 sides, which is round to a quarter of a texel. A blade is not round.
  const auto scene_with = [](bool wheel) {
    TinyScene tiny;
    tiny.quad({-20, -20, 0}, {20, -20, 0}, {20, 20, 0}, {-20, 20, 0});
    const uint32_t car = tiny.body("car"), part = tiny.body("car/part");
    tiny.object("car", car).box({-2, -0.5, 0.6}, {2, 0.5, 1.2});
    tiny.object("part", part);
    constexpr int sides = 48;
    for (int i = 0; wheel && i < sides; ++i) {
      const double a = 2 * pi * i / sides, b = 2 * pi * (i + 1) / sides;
      const auto p = [](double angle, double y) {
        return dvec3(0.5 * std::cos(angle), y, 0.5 * std::sin(angle));
      };
      tiny.triangle({0, 0, 0}, p(a, 0), p(b, 0)).triangle({0, 0.2, 0}, p(b, 0.2), p(a, 0.2));
      tiny.quad(p(a, 0), p(a, 0.2), p(b, 0.2), p(b, 0));
    }
    if (!wheel) tiny.box({-0.5, 0, -0.05}, {0.5, 0.2, 0.05});
    scene::Scene scene = tiny.build();
    scene.bodies[part].joint = scene::Joint{car, {1.3, 2.0, 0.5}, {0, 1, 0}};
    scene.bodies[car].reach = scene.bodies[car].bounds;
    scene.bodies[car].reach.add({1.9, 2.3, 1.1});
    scene.bodies[car].reach.add({0.7, 0.5, -0.1});
    return scene;
  };
  const Pose above = look({0, 0, 15}, 0.0, 90.0);
  for (const bool wheel : {true, false}) {
    const scene::Scene scene = scene_with(wheel);
    CameraRig rig(scene, plain_light(-60.0, 40.0), plain_camera(128));
    const Pose car{{1, 2, 0}, {1, 0, 0, 0}};
    const auto shoot = [&](double angle) {
      return rig.shoot(above, {car, car * scene.bodies[2].joint->pose(angle)});
    };
    const render::CameraImages still = shoot(0.0), turned = shoot(0.4);
    EXPECT_EQ(rig.lighting().shadows().moving().drawn_tiles(), wheel ? 1u : 2u);
    // What the camera sees of the ground is the same with the wheel, but not with the blade.
    size_t other = 0;
    for (size_t i = 0; i < still.instance.size(); ++i)
      other += still.instance[i] == 1u && turned.instance[i] == 1u && still.hdr[3 * i] != turned.hdr[3 * i];
    if (wheel)
      EXPECT_EQ(other, 0u);
    else
      EXPECT_GT(other, 3u);
  }
}

TEST(ClosedBodies, AreThoseWithoutHolesThatFaceOutwards) {
  TinyScene tiny;
  tiny.quad({-9, -9, 0}, {9, -9, 0}, {9, 9, 0}, {-9, 9, 0});
  const uint32_t two = tiny.body("two boxes"), open = tiny.body("open"), inside_out = tiny.body("inside out"),
                 same = tiny.body("two boxes again"), holes = tiny.body("holes");
  scene::Material fence;
  fence.pbr.alpha_mode = scene::AlphaMode::mask;
  const uint32_t masked = tiny.material_as(fence);
  tiny.object("a", two).box({-1, -1, 0}, {1, 1, 1}).box({-0.5, -0.5, 1}, {0.5, 0.5, 2});
  tiny.object("b", open).box({-1, -1, 0}, {1, 1, 1}).quad({0, 0, 2}, {1, 0, 2}, {1, 1, 2}, {0, 1, 2});
  tiny.object("c", inside_out).box({-1, -1, 0}, {1, 1, 3}).box({3, 1, 1}, {2, 0, 0});
  tiny.object("d", same).box({-1, -1, 0}, {1, 1, 1}).box({-0.5, -0.5, 1}, {0.5, 0.5, 2});
  tiny.object("e", holes, masked).box({-1, -1, 0}, {1, 1, 1});
  EXPECT_EQ(render::closed_bodies(tiny.build()), (std::vector<bool>{false, true, false, false, true, false}));
}

TEST(ClosedBodies, LookTheSameWithoutTheirBackFaces) {
  // A triangle hidden within the second body leaves it open, so that its back faces are drawn.
  const auto scene_with = [](bool open) {
    TinyScene tiny;
    tiny.quad({-30, -30, 0}, {30, -30, 0}, {30, 30, 0}, {-30, 30, 0});
    const uint32_t car = tiny.body("car");
    tiny.object("car", car).box({-2, -0.8, 0.2}, {2, 0.8, 1}).box({-1, -0.7, 1}, {1, 0.7, 1.6});
    if (open) tiny.triangle({0.1, 0.1, 0.4}, {0.2, 0.1, 0.4}, {0.1, 0.2, 0.4});
    return tiny.build();
  };
  ASSERT_TRUE(render::closed_bodies(scene_with(false))[1]);
  ASSERT_FALSE(render::closed_bodies(scene_with(true))[1]);
  CameraRig closed(scene_with(false), plain_light(60.0, 35.0), plain_camera(128)),
      open(scene_with(true), plain_light(60.0, 35.0), plain_camera(128));
  size_t differing = 0;
  for (int k = 0; k < 6; ++k) {
    const Pose car{{0.3 * k, -0.2 * k, 0.0}, orientation_from_yaw_pitch_roll(0.7 * k, 0.02 * k, -0.1 * k)};
    const Pose eye = look({-6, 1, 2.5}, -8.0, 12.0);
    const render::CameraImages a = closed.shoot(eye, {car}), b = open.shoot(eye, {car});
    EXPECT_EQ(a.instance, b.instance);
    // On the outline rounding may put a back face in front of the front face that it meets there.
    for (size_t i = 0; i < a.depth.size(); ++i) {
      if (a.depth[i] == b.depth[i] && a.hdr[3 * i] == b.hdr[3 * i]) continue;
      ++differing;
      EXPECT_NEAR(a.depth[i] / b.depth[i], 1.0f, 0.02f);
    }
  }
  EXPECT_LE(differing, 3u) << "of 6 x 128 x 128";
  // From within, the back faces are what there is to see.
  const render::CameraImages within = closed.shoot(look({0, 0, 0.6}), {Pose{}});
  EXPECT_THAT(within.instance, testing::Each(2u));
}

TEST(ClosedBodies, ThingsOfTheStaticWorldAreClosedOneByOne) {
  TinyScene tiny;
  scene::Material fence;
  fence.pbr.alpha_mode = scene::AlphaMode::mask;
  const uint32_t masked = tiny.material_as(fence), car = tiny.body("car");
  tiny.quad({-9, -9, 0}, {9, -9, 0}, {9, 9, 0}, {-9, 9, 0});
  tiny.object("closed").box({-1, -1, 0}, {1, 1, 1}).box({3, 3, 0}, {4, 4, 1});
  tiny.object("holes", 0, masked).box({-1, -1, 0}, {1, 1, 1});
  tiny.object("inside out").box({2, 2, 2}, {1, 1, 1});
  tiny.object("another body", car).box({-1, -1, 0}, {1, 1, 1});
  EXPECT_EQ(render::closed_instances(tiny.build()), (std::vector<bool>{false, true, false, false, false}));
}

TEST(ClosedBodies, OfTheStaticWorldLookTheSameWithoutTheirBackFaces) {
  // A triangle hidden within a house leaves it open, so that its back faces are drawn.
  const auto scene_with = [](bool open) {
    TinyScene tiny;
    tiny.quad({-30, -30, 0}, {30, -30, 0}, {30, 30, 0}, {-30, 30, 0});
    for (int k = 0; k < 5; ++k) {
      const dvec3 at(3.0 * k - 6.0, 1.3 * k - 2.0, 0.0);
      tiny.object("house " + std::to_string(k)).box(at, at + dvec3(1.1, 1.7, 2.0 + 0.3 * k));
      if (open) tiny.triangle(at + dvec3(0.1), at + dvec3(0.2, 0.1, 0.1), at + dvec3(0.1, 0.2, 0.1));
    }
    return tiny.build();
  };
  const scene::Scene closed_scene = scene_with(false), open_scene = scene_with(true);
  ASSERT_TRUE(render::closed_instances(closed_scene)[1]);
  ASSERT_FALSE(render::closed_instances(open_scene)[1]);
  CameraRig closed(closed_scene, plain_light(60.0, 35.0), plain_camera(128)),
      open(open_scene, plain_light(60.0, 35.0), plain_camera(128));
  size_t differing = 0;
  for (int k = 0; k < 8; ++k) {
    const Pose eye = look({-9.0 + 0.4 * k, 1, 2.5}, -8.0 + k, 12.0);
    const render::CameraImages a = closed.shoot(eye), b = open.shoot(eye);
    for (size_t i = 0; i < a.depth.size(); ++i) {
      const bool same =
          a.instance[i] == b.instance[i] && a.depth[i] == b.depth[i] && a.hdr[3 * i] == b.hdr[3 * i];
      differing += !same;
    }
  }
  EXPECT_LE(differing, 4u) << "of 8 x 128 x 128, on outlines";
  // From within a house, its back faces are what there is to see.
  EXPECT_THAT(closed.shoot(look({0.5, 1.2, 1.0})).instance, testing::Each(4u));
}

}  // namespace
}  // namespace greatx::test
