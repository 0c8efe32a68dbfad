// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Holds the light that glowing walls send against closed forms and the path-traced reference.
#include "renderer/light/wall_glow.h"

#include <cmath>
#include <cstring>
#include <iostream>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "renderer/light/light_gathering.h"
#include "renderer/light/surroundings_words.h"
#include "renderer/reference/reference_picture.h"
#include "shaders/shared/surroundings.h"
#include "tests/renderer/camera_rig.h"
#include "tests/renderer/columns.h"

namespace greatx::test {
namespace {

constexpr double shop_cd_m2 = 60.0, shop_m = 4.0, block_m = 12.0;

scene::Material shop_material(const std::string& name, double cd_m2) {
  scene::Material material = optical_material(name, 0.2f);
  material.pbr.emissive = vec3(float(cd_m2 / 1000.0));
  return material;
}

/// A house along y whose wall at x = 10 glows up to `shop_m`, on a square of 128 m.
TinyScene shop_street() {
  TinyScene tiny;
  tiny.object("ground", 0, tiny.material_as(optical_material("ground", 0.3f)))
      .quad({-64, -64, 0}, {64, -64, 0}, {64, 64, 0}, {-64, 64, 0});
  tiny.object("floors", 0, tiny.material_as(optical_material("wall", 0.2f)))
      .box({10, -60, shop_m}, {40, 60, block_m});
  tiny.object("shop", 0, tiny.material_as(shop_material("shop", shop_cd_m2)))
      .quad({10, 60, 0}, {10, -60, 0}, {10, -60, shop_m}, {10, 60, shop_m});
  return tiny;
}

/// The irradiance over pi of ground before an endless wall that glows up to a height.
double of_ground(double distance) {
  return shop_cd_m2 * 0.5 * (1.0 - distance / std::hypot(distance, shop_m));
}

TEST(WallGlow, TheLightOfAColumnIsThatOfItsTriangles) {
  const Columns columns(shop_street().build(), {}, {.glow = true});
  // Over the columns along the wall, radiance times height is that of the wall.
  const auto column = static_cast<uint32_t>((10.0 - columns.field.corner.x) / columns.field.cell_m);
  double sum = 0.0;
  uint32_t count = 0;
  for (uint32_t row = 0; row < columns.field.height; ++row) {
    const double y = columns.field.corner.y + (row + 0.5) * columns.field.cell_m;
    if (std::abs(y) > 50.0) continue;
    const render::SurroundingCell& cell = columns.surroundings.cell(column, row);
    EXPECT_EQ(cell.glow.high, dvec3(0.0));
    sum += cell.glow.low.x * double(shared::surroundings_glow_split);
    ++count;
  }
  EXPECT_NEAR(sum / count, shop_cd_m2 * shop_m, 0.01 * shop_cd_m2 * shop_m);
}

TEST(WallGlow, GroundBeforeShopsHasTheIlluminanceOfTheirFormFactor) {
  const Columns columns(shop_street().build(), {}, {.glow = true});
  const render::LightGathering gathering(columns.surroundings);
  for (const double distance : {1.5, 2.5, 4.0, 8.0, 16.0}) {
    // The mean over places along the wall, since places lie anywhere in their cells.
    double mean = 0.0;
    for (int k = 0; k < 20; ++k) mean += gathering.on_ground({10.0 - distance, 0.37 * k}, 0.0).x / 20.0;
    EXPECT_NEAR(mean / of_ground(distance), 1.0, 0.16) << distance;  // docs/global_light.md
  }
  const render::Surroundings dark(columns.scene, columns.field, {}, {.glow = false});
  EXPECT_EQ(render::LightGathering(dark).on_ground({8.0, 0.0}, 0.0), dvec3(0.0));
}

TEST(WallGlow, OfASignThatGlowsOnBothSidesOneIsSeen) {
  TinyScene tiny;
  tiny.quad({-32, -32, 0}, {32, -32, 0}, {32, 32, 0}, {-32, 32, 0});
  tiny.object("sign", 0, tiny.material_as(shop_material("sign", shop_cd_m2)))
      .quad({0.1, 2, 0}, {0.1, -2, 0}, {0.1, -2, 4}, {0.1, 2, 4})
      .quad({0.2, -2, 0}, {0.2, 2, 0}, {0.2, 2, 4}, {0.2, -2, 4});
  const Columns columns(tiny.build(), {}, {.glow = true});
  double flux = 0.0;
  for (const render::SurroundingCell& cell : columns.surroundings.cells())
    flux += cell.glow.low.x * std::min(double(cell.top), double(shared::surroundings_glow_split));
  EXPECT_NEAR(flux * columns.field.cell_m, shop_cd_m2 * 4.0 * 4.0, 0.02 * shop_cd_m2 * 16.0);
}

TEST(WallGlow, APictureOnAWallGlowsWhereItIsBright) {
  // The left half of the texture is dark. The quad shows it once.
  TinyScene tiny;
  scene::Texture texture;
  texture.width = 64;
  texture.height = 8;
  texture.srgb = true;
  for (uint32_t i = 0; i < 64 * 8; ++i)
    for (int c = 0; c < 4; ++c) texture.rgba.push_back(c == 3 || i % 64 >= 32 ? 255 : 0);
  scene::Material material = shop_material("shop", shop_cd_m2);
  material.pbr.emissive_texture = static_cast<int32_t>(tiny.texture(texture));
  tiny.quad({-32, -32, 0}, {32, -32, 0}, {32, 32, 0}, {-32, 32, 0});
  tiny.object("shop", 0, tiny.material_as(material))
      .quad({0.1, 16, 0}, {0.1, -16, 0}, {0.1, -16, 4}, {0.1, 16, 4});
  const Columns columns(tiny.build(), {}, {.glow = true});
  EXPECT_EQ(columns.at(0.1, 8.0).glow.low.x, 0.0);
  EXPECT_NEAR(columns.at(0.1, -8.0).glow.low.x, shop_cd_m2, 0.02 * shop_cd_m2);
}

TEST(WallGlow, MirrorImagesKnowItWithinAFifteenthOfItsLargestChannel) {
  for (const double luminance : {0.5, 3.0, 60.0, 900.0, 20000.0}) {
    TinyScene tiny;
    scene::Material material = shop_material("shop", luminance);
    material.pbr.emissive *= vec3(1.0f, 0.61f, 0.23f);
    tiny.quad({-32, -32, 0}, {32, -32, 0}, {32, 32, 0}, {-32, 32, 0});
    tiny.object("shop", 0, tiny.material_as(material))
        .quad({0.1, 16, 0}, {0.1, -16, 0}, {0.1, -16, 8}, {0.1, 16, 8});
    const Columns columns(tiny.build(), {}, {.glow = true});
    const std::vector<uint32_t> words = render::surroundings_words(columns.surroundings, false);
    shared::SurroundingsHeader header;
    std::memcpy(&header, words.data(), sizeof header);
    size_t glowing = 0;
    for (size_t i = 0; i < columns.surroundings.cells().size(); ++i) {
      const render::WallGlow& glow = columns.surroundings.cells()[i].glow;
      const uint32_t both = words[2 * (header.first_color + shared::surroundings_color_pairs * i) + 3];
      for (const auto& [radiance, word] :
           {std::pair(glow.low, both & 0xffffu), std::pair(glow.high, both >> 16)}) {
        const double largest = radiance.x, step = std::exp2(word >> 12) / 15.0;
        for (int c = 0; c < 3; ++c)
          ASSERT_NEAR(step * (word >> 4 * c & 15u), radiance[c], std::max(largest, 0.5) / 14.9);
        glowing += largest > 0.0;
      }
    }
    EXPECT_GT(glowing, 60u);
  }
}

TEST(WallGlow, PicturesOfAStreetWithShopsAgreeWithTheReference) {
  const scene::Scene scene = shop_street().build();
  render::CameraEffects effects = lambertian();
  effects.ambient_occlusion = true;
  render::Lighting lighting;
  lighting.sky_model = render::SkyModel::uniform;
  lighting.sun_illuminance_lux = 0.0;
  lighting.sky_illuminance_lux = 0.4;
  render::CameraDesc desc = plain_camera(24);
  desc.outputs = {};
  desc.outputs.hdr = true;
  const Pose eye = look({1.0, 0.0, 4.0}, 20.0, 40.0);  // to the ground before the shops
  const std::vector<Pose> poses(scene.bodies.size());
  render::ReferenceOptions options;
  options.samples = 256;
  options.paths.bounces = 1;
  effects.bounced_light = true;
  const render::ReferencePicture reference =
      render::trace_reference(scene, poses, lighting, effects, desc, eye, options);
  const std::vector<uint8_t> counted(reference.coverage.size(), 1);
  const auto error_with = [&](bool glow) {
    render::CameraEffects with = effects;
    with.emissive = glow;
    const render::CameraImages images = CameraRig(scene, lighting, desc, with).shoot(eye);
    return render::compare_with(reference, images.hdr, counted, 30.0);
  };
  const render::ReferenceError with = error_with(true), without = error_with(false);
  std::cout << fmt::format("shops: rmse {:.3f}, bias {:+.3f} without; {:.3f}, {:+.3f} with\n", without.rmse,
                           without.bias, with.rmse, with.bias);
  EXPECT_LT(without.bias, -0.8);
  EXPECT_LT(std::abs(with.bias), 0.15);
  EXPECT_LT(with.rmse, 0.25);
}

TEST(LampGlass, IsWhatLiesWhollyBesideALightOfItsBody) {
  scene::Scene scene = shop_street().build();
  scene.lights.push_back({.name = "lamp", .position = {3, 4, 5}});
  scene.lights.push_back({.name = "of a body", .position = {0, 0, 0}, .body = 2});
  const render::LampGlass glass(scene);
  const auto triangle = [](const dvec3& at, double size) {
    return std::array<dvec3, 3>{at, at + dvec3(size, 0, 0), at + dvec3(0, size, 0)};
  };
  EXPECT_TRUE(glass.is_glass(0, triangle({3.1, 4, 5.2}, 0.3)));
  EXPECT_FALSE(glass.is_glass(0, triangle({3.1, 4, 5.2}, 1.2)));  // a wall beside it
  EXPECT_FALSE(glass.is_glass(0, triangle({4.1, 4, 5}, 0.3)));
  EXPECT_FALSE(glass.is_glass(1, triangle({3.1, 4, 5.2}, 0.3)));
  EXPECT_FALSE(glass.is_glass(0, triangle({0.1, 0, 0}, 0.3)));
  EXPECT_TRUE(glass.is_glass(2, triangle({0.1, 0, 0}, 0.3)));
}

}  // namespace
}  // namespace greatx::test
