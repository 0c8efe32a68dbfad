// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Textures are layers of images of their size. The tests check that pictures do not depend on the way in
// which shaders select the image.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "shaders/shared/scene.h"
#include "tests/renderer/camera_rig.h"

namespace greatx {
namespace {

using test::CameraRig;
using test::TinyScene;

/// Returns a linear texture of one grey.
scene::Texture grey_texture(uint32_t width, uint32_t height, uint8_t value) {
  scene::Texture texture;
  texture.name = "grey";
  texture.width = width;
  texture.height = height;
  texture.srgb = false;
  texture.rgba.assign(size_t{4} * width * height, value);
  return texture;
}

uint8_t grey_of(uint32_t strip) { return static_cast<uint8_t>(60 + 6 * strip); }

/// Returns level strips across the view. Each has a texture of a different size, except that the last one has
/// the size of the first.
scene::Scene strips(uint32_t count) {
  TinyScene tiny;
  const double width = 8.0 / count;
  for (uint32_t i = 0; i < count; ++i) {
    scene::Material painted = test::optical_material("strip", 1.0f);
    painted.pbr.base_color_texture =
        int32_t(tiny.texture(grey_texture(i + 1 == count ? 4 : 4 + i, 4, grey_of(i))));
    const double y = -4.0 + i * width;
    tiny.object("strip", 0, tiny.material_as(painted))
        .quad({-4, y, 0}, {4, y, 0}, {4, y + width, 0}, {-4, y + width, 0});
  }
  return tiny.build();
}

void expect_greys(uint32_t count) {
  CameraRig rig(strips(count), test::plain_light(), test::plain_camera(64), test::lambertian());
  const render::CameraImages images = rig.shoot(test::look({0, 0, 3.9}, 0.0, 90.0));
  std::vector<uint32_t> seen(count);
  for (size_t i = 0; i < images.instance.size(); ++i) {
    ASSERT_GT(images.instance[i], 0u);
    const uint32_t strip = images.instance[i] - 1;
    ++seen[strip];
    EXPECT_NEAR(test::luminance_at(images, i) / (grey_of(strip) / 255.0 * 115000.0 / pi), 1.0, 3e-3)
        << "strip " << strip;
  }
  for (uint32_t strip = 0; strip < count; ++strip) EXPECT_GT(seen[strip], 60u) << strip;
}

TEST(Textures, ShadersAskAFewImagesOneByOne) { expect_greys(12); }

TEST(Textures, ShadersPickAmongManyImagesByNumber) {
  const uint32_t many = shared::most_tried_arrays + 4;
  if (!test::device().info().has_texture_table()) GTEST_SKIP() << "the device has no table of textures";
  const scene::Scene scene = strips(many);
  const scene::GpuScene gpu(test::device(), scene, {.acceleration_structure = false});
  EXPECT_EQ(gpu.textures().arrays_of(&scene::MaterialTextures::base_color), 0u);
  expect_greys(many);
}

TEST(FewTextures, ADeviceWithoutTheTableHoldsAFewAndSaysSo) {
  if (test::device().info().has_texture_table()) GTEST_SKIP() << "the device has the table of textures";
  expect_greys(shared::most_tried_arrays);
  const scene::Scene scene = strips(shared::most_tried_arrays + 4);
  try {
    const scene::GpuScene gpu(test::device(), scene, {.acceleration_structure = false});
    ADD_FAILURE() << "more images than shaders may try were accepted";
  } catch (const UserError& error) {
    EXPECT_THAT(error.what(), testing::HasSubstr("at most 16 different sizes"));
    EXPECT_THAT(error.what(), testing::HasSubstr("no table of textures"));
  }
}

/// Returns a texture of noise, sRGB.
scene::Texture noise(uint32_t width, uint32_t height, uint32_t seed) {
  scene::Texture texture = grey_texture(width, height, 255);
  texture.srgb = true;
  for (size_t i = 0; i < texture.rgba.size(); ++i)
    if (i % 4 != 3) texture.rgba[i] = static_cast<uint8_t>((i * 2654435761u + seed * 40503u) >> 13);
  return texture;
}

/// Returns a floor of 8 m with a small repeated texture, beside a patch of another texture.
scene::Scene floor_and_patch(const scene::Texture& on_floor, const scene::Texture& on_patch) {
  TinyScene tiny;
  const auto painted = [&](const scene::Texture& texture) {
    scene::Material material = test::optical_material("painted", 1.0f);
    material.pbr.base_color_texture = int32_t(tiny.texture(texture));
    return tiny.material_as(material);
  };
  tiny.object("floor", 0, painted(on_floor)).quad({-4, -4, 0}, {4, -4, 0}, {4, 4, 0}, {-4, 4, 0});
  tiny.object("patch", 0, painted(on_patch)).quad({9, 9, 0}, {10, 9, 0}, {10, 10, 0}, {9, 10, 0});
  return tiny.build();
}

TEST(Textures, LaidSideBySideGiveTheSamePicture) {
  // The floor is the same in both scenes. The patch, which is out of sight, has a size that is a multiple of
  // the floor's texture in one scene only.
  std::vector<std::vector<float>> pictures;
  for (const uint32_t width : {64u, 68u}) {
    CameraRig rig(floor_and_patch(noise(16, 8, 1), noise(width, 32, 2)), test::plain_light(),
                  test::plain_camera(64), test::lambertian());
    pictures.push_back(rig.shoot(test::look({0.3, 0.2, 2.0}, 30.0, 60.0)).hdr);
  }
  double most = 0.0, difference = 0.0;
  for (size_t i = 0; i < pictures[0].size(); ++i) {
    most = std::max(most, double(pictures[0][i]));
    difference = std::max(difference, std::abs(double(pictures[0][i]) - pictures[1][i]));
  }
  EXPECT_GT(most, 0.0);
  EXPECT_LT(difference, 2e-3 * most);  // rounding to fp16, and coordinates scaled by a power of two
}

TEST(Textures, RoughnessInTheAlphaOfColoursGivesTheSamePicture) {
  // A roughness texture of the size of the colours goes into their alpha; one twice as large remains a
  // texture of its own.
  std::vector<std::vector<float>> pictures;
  for (const uint32_t size : {16u, 32u}) {
    TinyScene tiny;
    scene::Material material = test::optical_material("painted", 1.0f);
    material.pbr.base_color_texture = int32_t(tiny.texture(noise(16, 16, 3)));
    material.pbr.metallic_roughness_texture = int32_t(tiny.texture(grey_texture(size, size, 77)));
    material.pbr.metallic = 1.0f;
    material.pbr.roughness = 0.9f;
    tiny.object("floor", 0, tiny.material_as(material)).quad({-4, -4, 0}, {4, -4, 0}, {4, 4, 0}, {-4, 4, 0});
    CameraRig rig(tiny.build(), test::plain_light(), test::plain_camera(64), {.specular = true});
    pictures.push_back(rig.shoot(test::look({0.3, 0.2, 2.0}, 30.0, 60.0)).hdr);
  }
  for (size_t i = 0; i < pictures[0].size(); ++i)
    ASSERT_NEAR(pictures[0][i], pictures[1][i], 2e-3f * pictures[1][i]) << i;
}

TEST(Textures, OfSceneWithoutAnyCanStillBeBound) {
  TinyScene tiny;
  tiny.quad({-4, -4, 0}, {4, -4, 0}, {4, 4, 0}, {-4, 4, 0});
  CameraRig rig(tiny.build(), test::plain_light(), test::plain_camera(16), test::lambertian());
  EXPECT_GT(rig.shoot(test::look({0, 0, 3.9}, 0.0, 90.0)).hdr[0], 0.0f);
}

}  // namespace
}  // namespace greatx
