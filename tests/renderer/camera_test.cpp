// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Checks the geometry of the camera: depth, ids, samples, ticks in flight and the set of pipelines it builds.
#include "renderer/camera/camera.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/error.h"
#include "tests/renderer/camera_rig.h"

namespace greatx::test {
namespace {

constexpr float infinity = std::numeric_limits<float>::infinity();

/// Returns the planar depth of the plane n . x = offset (local frame) through the centre of a pixel.
double plane_depth(const render::CameraDesc& desc, const Pose& sensor, uint32_t column, uint32_t row,
                   const dvec3& n, double offset) {
  return (offset - glm::dot(n, sensor.position)) / glm::dot(n, sensor.rotate(pixel_ray(desc, column, row)));
}

double worst_relative_error(const render::CameraDesc& desc, const render::CameraImages& images,
                            const Pose& sensor, const dvec3& n, double offset) {
  double worst = 0.0;
  for (uint32_t row = 0; row < desc.height; ++row)
    for (uint32_t column = 0; column < desc.width; ++column) {
      const double exact = plane_depth(desc, sensor, column, row, n, offset);
      const float found = images.depth[row * desc.width + column];
      if (found != infinity) worst = std::max(worst, std::abs(found / exact - 1.0));
    }
  return worst;
}

size_t sky_pixels(const render::CameraImages& images) {
  return size_t(std::ranges::count(images.depth, infinity));
}

TEST(Camera, DepthOfATiltedPlaneAtEveryPixel) {
  // The plane z = 0.3 x - 0.2 y + 5 extends over 60 m and is seen obliquely from above.
  const auto z = [](double x, double y) { return 0.3 * x - 0.2 * y + 5.0; };
  const auto p = [&](double x, double y) { return dvec3(x, y, z(x, y)); };
  const dvec3 n = glm::normalize(dvec3(-0.3, 0.2, 1.0));
  for (const uint32_t msaa : {1u, 4u}) {
    render::CameraDesc desc = plain_camera(65, msaa);
    desc.height = 47;
    desc.fx = 71.3;
    desc.fy = 64.7;
    desc.cx = 20.25;  // far from the middle
    desc.cy = 30.5;
    TinyScene tiny;
    tiny.quad(p(-60, -60), p(60, -60), p(60, 60), p(-60, 60));
    CameraRig rig(tiny.build(), plain_light(), desc);
    const Pose sensor = look({-4.0, 3.0, 20.0}, 33.0, 62.0, 11.0);
    const render::CameraImages images = rig.shoot(sensor);
    EXPECT_EQ(sky_pixels(images), 0u);
    EXPECT_LE(worst_relative_error(desc, images, sensor, n, 5.0 * n.z), 1e-5) << msaa;
  }
}

TEST(Camera, DepthOfWideGroundThatPassesUnderTheEye) {
  // Two triangles with a side of 2 km lie 1.6 m below the eye. They are clipped at the near plane and reach
  // to the horizon.
  TinyScene tiny;
  tiny.quad({-1000, -1000, 0}, {1000, -1000, 0}, {1000, 1000, 0}, {-1000, 1000, 0});
  const render::CameraDesc desc = plain_camera(128, 4);
  CameraRig rig(tiny.build(), plain_light(), desc);
  const Pose sensor = look({0.1, 0.2, 1.6}, 20.0, 5.0);
  const render::CameraImages images = rig.shoot(sensor);
  EXPECT_LT(sky_pixels(images), images.depth.size() / 2);
  EXPECT_LE(worst_relative_error(desc, images, sensor, {0, 0, 1}, 0.0), 1e-5);
}

TEST(HardCase, N57_DepthFromADecimetreToTenKilometres) {
  // The near plane is at 0.1 m, the far one at 1e4 m. Two walls stand one behind the other: reversed Z in
  // fp32 distinguishes 1 km from 1 km + 1 mm, and 10 km from 10 km + 10 cm. The planar depth is accurate to
  // 7e-5 m at 1 km.
  for (const auto& [distance, gap] :
       {std::pair{1000.0, 1e-3}, std::pair{10000.0, 0.1}, std::pair{0.2, 1e-6}}) {
    TinyScene tiny;
    for (int i = 0; i < 2; ++i) {
      const double x = distance + i * gap, w = 3.0 * distance;
      tiny.object(i == 0 ? "near" : "far").quad({x, w, -w}, {x, -w, -w}, {x, -w, w}, {x, w, w});
    }
    for (const uint32_t msaa : {1u, 4u}) {
      const render::CameraDesc desc = plain_camera(64, msaa);
      CameraRig rig(tiny.build(), plain_light(), desc);
      const render::CameraImages images = rig.shoot(look({0, 0, 0}));
      for (size_t i = 0; i < images.depth.size(); ++i) {
        EXPECT_NEAR(images.depth[i], distance, 7e-8 * distance) << i;
        EXPECT_EQ(images.instance[i], 1u) << i;
      }
      // A camera that looks the other way sees only the sky.
      const render::CameraImages behind = rig.shoot(look({0, 0, 0}, 180.0));
      EXPECT_EQ(sky_pixels(behind), behind.depth.size());
    }
  }
}

TEST(HardCase, N64_EmptySceneIsSkyAndFinite) {
  for (const uint32_t msaa : {1u, 4u}) {
    CameraRig rig(TinyScene().build(), plain_light(10.0, 40.0), plain_camera(33, msaa));
    const render::CameraImages images = rig.shoot(look({0, 0, 0}, 0.0, -30.0));
    EXPECT_EQ(sky_pixels(images), 33u * 33u);
    EXPECT_THAT(images.instance, testing::Each(0u));
    EXPECT_THAT(images.material, testing::Each(0u));
    EXPECT_THAT(images.semantic, testing::Each(0u));
    EXPECT_THAT(images.hdr, testing::Each(testing::AllOf(testing::Gt(0.0f), testing::Lt(infinity))));
    EXPECT_THAT(images.rgb, testing::Each(testing::Gt(0)));
  }
}

/// Holds boxes at irregular places and traces rays through them on the CPU.
struct Boxes {
  struct Box {
    dvec3 low, high;
  };
  std::vector<Box> boxes{{{5.03, -2.11, -1.07}, {6.21, -0.53, 0.77}},
                         {{7.31, -1.01, -1.57}, {9.13, 1.43, 1.29}},
                         {{4.17, 0.61, -0.91}, {4.83, 1.87, 2.03}}};
  scene::Scene build() const {
    TinyScene tiny;
    for (size_t i = 0; i < boxes.size(); ++i) {
      const uint32_t material =
          tiny.material_as(optical_material(fmt::format("m{}", i), 0.2f + 0.3f * float(i)));
      tiny.object(fmt::format("box {}", i), 0, material).box(boxes[i].low, boxes[i].high);
    }
    scene::Scene scene = tiny.build();
    scene.instances[0].semantic_class = scene::SemanticClass::building;
    scene.instances[1].semantic_class = scene::SemanticClass::vehicle;
    scene.instances[2].semantic_class = scene::SemanticClass::pole;
    return scene;
  }
  /// Returns the index + 1 of the first box that the ray meets, and the ray parameter of the intersection.
  std::pair<uint32_t, double> trace(const dvec3& origin, const dvec3& direction) const {
    std::pair<uint32_t, double> nearest{0, 1e300};
    for (uint32_t i = 0; i < boxes.size(); ++i) {
      const dvec3 a = (boxes[i].low - origin) / direction, b = (boxes[i].high - origin) / direction;
      const dvec3 low = glm::min(a, b), high = glm::max(a, b);
      const double enter = std::max({low.x, low.y, low.z}), leave = std::min({high.x, high.y, high.z});
      if (enter > 0.0 && enter < leave && enter < nearest.second) nearest = {i + 1, enter};
    }
    return nearest;
  }
};

TEST(Camera, IdsAndDepthAreThoseOfTheRayThroughThePixel) {
  const Boxes boxes;
  for (const uint32_t msaa : {1u, 4u}) {
    const render::CameraDesc desc = plain_camera(96, msaa);
    CameraRig rig(boxes.build(), plain_light(), desc);
    const Pose sensor = look({0.13, 0.21, 0.17}, 3.0, 2.0, 1.0);
    const render::CameraImages images = rig.shoot(sensor);
    size_t seen[4] = {}, wrong = 0;
    for (uint32_t row = 0; row < desc.height; ++row)
      for (uint32_t column = 0; column < desc.width; ++column) {
        const size_t i = row * desc.width + column;
        const auto [expected, t] = boxes.trace(sensor.position, sensor.rotate(pixel_ray(desc, column, row)));
        ++seen[expected];
        const bool same_depth =
            expected == 0 ? images.depth[i] == infinity : std::abs(images.depth[i] / t - 1.0) <= 1e-5;
        if (images.instance[i] != expected || !same_depth) {
          ++wrong;
          continue;
        }
        const uint32_t classes[] = {0, 5, 12, 9};
        EXPECT_EQ(images.semantic[i], classes[expected]);
        EXPECT_EQ(images.material[i],
                  expected == 0 ? 0u : expected + 1);  // material 0 is the default one of TinyScene
      }
    for (const size_t count : seen) EXPECT_GT(count, 50u);
    // With four samples, a triangle may cover the centre of a pixel but none of the samples. This happens to
    // a few pixels at corners.
    EXPECT_LE(wrong, msaa == 1 ? 0u : 4u);
  }
}

TEST(Camera, OneAndFourSamplesAgreeInside) {
  const Boxes boxes;
  const Pose sensor = look({0, 0, 0}, 2.0, 0.0);
  CameraRig one(boxes.build(), plain_light(30, 50), plain_camera(96, 1)),
      four(boxes.build(), plain_light(30, 50), plain_camera(96, 4));
  const render::CameraImages a = one.shoot(sensor), b = four.shoot(sensor);
  size_t compared = 0;
  for (size_t row = 1; row + 1 < 96; ++row)
    for (size_t column = 1; column + 1 < 96; ++column) {
      const size_t i = row * 96 + column;
      bool inside = true;
      for (const size_t k : {i - 97, i - 96, i - 95, i - 1, i + 1, i + 95, i + 96, i + 97})
        inside = inside && a.instance[k] == a.instance[i];
      if (!inside) continue;
      ++compared;
      EXPECT_EQ(a.instance[i], b.instance[i]);
      if (a.depth[i] != infinity) {
        EXPECT_NEAR(b.depth[i] / a.depth[i], 1.0, 1e-6);
      }
    }
  EXPECT_GT(compared, 8000u);
}

TEST(Camera, FourSamplesBlendAtAnEdge) {
  // A white emitting half plane stands before black. Only with four samples do the pixels on the slanted edge
  // have values in between.
  TinyScene tiny;
  scene::Material glow = optical_material("glow", 0.0f);
  glow.pbr.emissive = vec3(1.0f);
  tiny.object("half", 0, tiny.material_as(glow)).triangle({10, 40, -40}, {10, -31, -40}, {10, 23, 40});
  render::CameraEffects effects;
  effects.sky = effects.sun = false;
  size_t between[2] = {};
  for (const uint32_t msaa : {1u, 4u}) {
    CameraRig rig(tiny.build(), plain_light(), plain_camera(64, msaa), effects);
    const render::CameraImages images = rig.shoot(look({0, 0, 0}));
    for (size_t i = 0; i < images.depth.size(); ++i)
      if (images.hdr[3 * i] > 1.0f && images.hdr[3 * i] < 999.0f) ++between[msaa / 4];
  }
  EXPECT_EQ(between[0], 0u);
  EXPECT_GT(between[1], 20u);
}

TEST(Camera, MovingBodyMovesAndCanBeExcluded) {
  TinyScene tiny;
  const uint32_t body = tiny.body("drone");
  tiny.object("drone", body).box({-0.5, -0.5, -0.5}, {0.5, 0.5, 0.5});
  render::CameraDesc desc = plain_camera(64, 4);
  CameraRig rig(tiny.build(), plain_light(), desc);
  const auto middle = [](const render::CameraImages& images) {
    dvec2 sum(0.0);
    double count = 0.0;
    for (size_t i = 0; i < images.instance.size(); ++i)
      if (images.instance[i] == 1) {
        sum += dvec2(double(i % 64) + 0.5, double(i / 64) + 0.5);
        ++count;
      }
    return count == 0.0 ? dvec2(-1.0) : sum / count;
  };
  for (const dvec3& at : {dvec3(5, 0, 0), dvec3(5, 2, 1), dvec3(5, -2, -1)}) {
    const dvec2 seen = middle(rig.shoot(look({0, 0, 0}), {Pose{at, {1, 0, 0, 0}}}));
    EXPECT_NEAR(seen.x, 32.0 - 32.0 * at.y / 4.5, 1.0);  // the face of the box is 4.5 m away
    EXPECT_NEAR(seen.y, 32.0 - 32.0 * at.z / 4.5, 1.0);
  }
  desc.excluded_body = body;
  CameraRig blind(tiny.build(), plain_light(), desc);
  EXPECT_EQ(middle(blind.shoot(look({0, 0, 0}), {Pose{{5, 0, 0}, {1, 0, 0, 0}}})).x, -1.0);
}

TEST(Camera, FarFromTheOriginNothingJitters) {
  // The eye is 50 km away from the local origin. Positions are taken relative to the eye before they are
  // rounded.
  TinyScene tiny;
  const uint32_t body = tiny.body("plate");
  tiny.object("plate", body).quad({0, 8, -8}, {0, -8, -8}, {0, -8, 8}, {0, 8, 8});
  const render::CameraDesc desc = plain_camera(32, 1);
  CameraRig rig(tiny.build(), plain_light(), desc);
  const dvec3 far(50000.0, -30000.0, 100.0);
  const render::CameraImages images = rig.shoot(look(far), {Pose{far + dvec3(4.0, 0, 0), {1, 0, 0, 0}}});
  for (const float depth : images.depth) EXPECT_NEAR(depth, 4.0f, 1e-6f);
}

TEST(Camera, SameBytesTwiceAndInTwoSlots) {
  const Boxes boxes;
  const auto same = [](const render::CameraImages& a, const render::CameraImages& b) {
    return a.rgb == b.rgb && a.hdr == b.hdr && a.depth == b.depth && a.instance == b.instance &&
           a.semantic == b.semantic && a.material == b.material;
  };
  CameraRig rig(boxes.build(), plain_light(30, 50), plain_camera(50, 4)),
      again(boxes.build(), plain_light(30, 50), plain_camera(50, 4));
  const Pose first = look({0, 0, 0}), second = look({0, 0, 0}, 10.0);
  const render::CameraImages a = rig.shoot(first), b = rig.shoot(second);
  EXPECT_FALSE(same(a, b));
  EXPECT_TRUE(same(a, rig.shoot(first)));
  EXPECT_TRUE(same(a, again.shoot(first)));
  // Both pictures are in flight at once.
  gpu::TickSlot& slot_a = rig.record(first);
  gpu::TickSlot& slot_b = rig.record(second);
  EXPECT_TRUE(same(a, rig.collect(slot_a)));
  EXPECT_TRUE(same(b, rig.collect(slot_b)));
}

// The scene has more triangles than the device lets a shader bind at once: shaders read their records by
// address.
TEST(Camera, TablesReadByTheirAddressGiveTheSamePicture) {
  const Boxes boxes;
  const Pose eye = look({0, 0, 0});
  for (const bool smooth : {false, true}) {
    render::CameraDesc desc = plain_camera(50, smooth ? 1 : 4);
    desc.smooth_edges = smooth;
    CameraRig bound(boxes.build(), plain_light(30, 50), desc),
        addressed(boxes.build(), plain_light(30, 50), desc, {},
                  {.acceleration_structure = false, .textures = true, .most_table_bytes = 64});
    const render::CameraImages a = bound.shoot(eye), b = addressed.shoot(eye);
    EXPECT_EQ(a.hdr, b.hdr) << smooth;
    EXPECT_EQ(a.depth, b.depth) << smooth;
    EXPECT_EQ(a.instance, b.instance) << smooth;
  }
}

TEST(Camera, AlphaMaskLetsSeeThrough) {
  TinyScene tiny;
  scene::Texture texture;
  texture.name = "half";
  texture.width = 8;
  texture.height = 8;
  texture.rgba.assign(8 * 8 * 4, 255);
  for (size_t i = 0; i < 64; ++i)
    if (i % 8 >= 4) texture.rgba[4 * i + 3] = 0;  // the mask cuts the right half (u > 0.5) away
  scene::Material leaf = optical_material("leaf", 1.0f);
  leaf.pbr.base_color_texture = int32_t(tiny.texture(texture));
  leaf.pbr.alpha_mode = scene::AlphaMode::mask;
  const uint32_t leaf_id = tiny.material_as(leaf), wall_id = tiny.material_as(optical_material("wall", 0.5f));
  tiny.object("leaf", 0, leaf_id).quad({4, 4, -4}, {4, -4, -4}, {4, -4, 4}, {4, 4, 4});
  tiny.object("wall", 0, wall_id).quad({6, 9, -9}, {6, -9, -9}, {6, -9, 9}, {6, 9, 9});
  for (const bool textures : {true, false}) {
    render::CameraEffects effects;
    effects.textures = textures;  // the mask works without colour textures
    CameraRig rig(tiny.build(), plain_light(), plain_camera(64, 1), effects);
    const render::CameraImages images = rig.shoot(look({0, 0, 0}));
    for (size_t row = 0; row < 64; ++row)
      for (size_t column = 0; column < 64; ++column) {
        if (column >= 28 && column < 36) continue;  // the texture filter blends here
        EXPECT_EQ(images.instance[row * 64 + column], column < 32 ? 1u : 2u) << row << " " << column;
      }
  }
  render::CameraEffects solid;
  solid.alpha_mask = false;
  CameraRig rig(tiny.build(), plain_light(), plain_camera(64, 1), solid);
  EXPECT_THAT(rig.shoot(look({0, 0, 0})).instance, testing::Each(1u));
}

TEST(Camera, EffectsThatAreOffAreNotBuiltAndChangeNothingElse) {
  TinyScene tiny;
  const uint32_t body = tiny.body("car");
  tiny.quad({-20, -20, 0}, {20, -20, 0}, {20, 20, 0}, {-20, 20, 0});
  tiny.object("car", body).box({-1, -1, 0}, {1, 1, 1});
  const auto pipelines_of = [&](const render::CameraEffects& effects, const render::CameraOutputs& outputs,
                                render::CameraImages& images) {
    const size_t before = device().counters().pipelines.size();
    render::CameraDesc desc = plain_camera(64, 4);
    desc.outputs = outputs;
    CameraRig rig(tiny.build(), plain_light(40, 40), desc, effects);
    images = rig.shoot(look({-8, 0, 5}, 0.0, 30.0), {Pose{{2, 1, 0}, {1, 0, 0, 0}}});
    const auto& all = device().counters().pipelines;
    return std::vector<std::string>(all.begin() + ptrdiff_t(before), all.end());
  };
  render::CameraImages full, unshadowed, geometry;
  EXPECT_THAT(pipelines_of({}, {}, full),
              testing::ElementsAre("static shadow", "moving shadow of closed bodies", "camera visibility",
                                   "camera visibility of bodies", "camera visibility of closed bodies",
                                   "camera shade", "camera develop"));
  render::CameraEffects none{};
  none.sun = none.sky = none.textures = none.normal_maps = none.alpha_mask = none.emissive = false;
  none.punctual_lights = none.specular = false;  // shadows go off with the sun
  EXPECT_THAT(pipelines_of(none, {}, unshadowed),
              testing::ElementsAre("camera visibility", "camera visibility of bodies",
                                   "camera visibility of closed bodies", "camera shade", "camera develop"));
  EXPECT_NE(full.rgb, unshadowed.rgb);
  EXPECT_EQ(full.depth, unshadowed.depth);
  EXPECT_EQ(full.instance, unshadowed.instance);
  render::CameraOutputs depth_only{};
  depth_only.rgb = depth_only.instance = depth_only.semantic = depth_only.material = false;
  pipelines_of(none, depth_only, geometry);
  EXPECT_EQ(full.depth, geometry.depth);
  EXPECT_TRUE(geometry.rgb.empty() && geometry.instance.empty());
  render::CameraOutputs rgb_only{};
  rgb_only.depth = rgb_only.instance = rgb_only.semantic = rgb_only.material = false;
  pipelines_of({}, rgb_only, geometry);
  EXPECT_EQ(full.rgb, geometry.rgb);
}

TEST(Camera, WhatIsOutOfViewIsNotDrawn) {
  const Boxes boxes;
  CameraRig rig(boxes.build(), plain_light(), plain_camera());
  rig.shoot(look({0, 0, 0}));
  EXPECT_EQ(rig.camera().drawn(), 1u) << "the boxes stand together";
  rig.shoot(look({0, 0, 0}, 180.0));
  EXPECT_EQ(rig.camera().drawn(), 0u);
  EXPECT_EQ(rig.camera().culled(), 1u);
}

TEST(Camera, RefusesNonsenseByName) {
  const auto message = [](const std::function<void(render::CameraDesc&)>& spoil) -> std::string {
    render::CameraDesc desc = plain_camera();
    desc.name = "front";
    spoil(desc);
    try {
      CameraRig rig(TinyScene().build(), plain_light(), desc);
    } catch (const UserError& error) {
      return error.what();
    }
    return "accepted";
  };
  using render::CameraDesc;
  EXPECT_THAT(message([](CameraDesc& d) { d.fx = 0.0; }), testing::HasSubstr("camera front: fx"));
  EXPECT_THAT(message([](CameraDesc& d) { d.fy = NAN; }), testing::HasSubstr("fy"));
  EXPECT_THAT(message([](CameraDesc& d) { d.near_m = -1.0; }), testing::HasSubstr("near_m"));
  EXPECT_THAT(message([](CameraDesc& d) { d.msaa = 3; }), testing::HasSubstr("msaa"));
  EXPECT_THAT(message([](CameraDesc& d) { d.width = 0; }), testing::HasSubstr("width"));
  const VkPhysicalDeviceLimits& limits = device().limits();
  const uint64_t edge = limits.maxImageDimension2D;
  if (limits.maxStorageBufferRange / 8 < edge * edge) {
    EXPECT_THAT(message([&](CameraDesc& d) { d.width = d.height = limits.maxImageDimension2D; }),
                testing::HasSubstr("camera front: width, height: expected at most"));
  }
  EXPECT_THAT(message([](CameraDesc& d) { d.exposure_ev100 = 99.0; }), testing::HasSubstr("exposure_ev100"));
  EXPECT_THAT(message([](CameraDesc& d) { d.outputs = {false, false, false, false, false, false}; }),
              testing::HasSubstr("outputs"));
  render::Lighting lighting = plain_light();
  lighting.turbidity = 0.0;
  EXPECT_THROW(CameraRig(TinyScene().build(), lighting, plain_camera()), UserError);
}

}  // namespace
}  // namespace greatx::test
