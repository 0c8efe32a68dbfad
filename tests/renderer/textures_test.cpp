// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Textures are layers of images of their size, and pictures look the same whichever way shaders pick the image.
#include <gtest/gtest.h>

#include "shaders/shared/scene.h"
#include "tests/renderer/camera_rig.h"

namespace greatx {
namespace {

using test::CameraRig;
using test::TinyScene;

/// Of one grey, linear.
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

/// Level strips across the view, each with a texture of a size of its own; the last has the first one's size.
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

TEST(Textures, OfOneSizeAreLayersOfOneImage) {
  const scene::Scene scene = strips(6);
  const scene::GpuScene gpu(test::device(), scene, {.acceleration_structure = false});
  const scene::GpuTextures& textures = gpu.textures();
  EXPECT_EQ(textures.reference(-1), -1);
  EXPECT_EQ(textures.reference(0) >> 16, textures.reference(5) >> 16);
  EXPECT_EQ(textures.reference(0) & 0xffff, 0);
  EXPECT_EQ(textures.reference(5) & 0xffff, 1);
  for (int32_t i = 1; i < 5; ++i) EXPECT_NE(textures.reference(i) >> 16, textures.reference(0) >> 16);
  EXPECT_EQ(textures.arrays_of(&scene::PbrMaterial::normal_texture), 0u);
  if (test::device().info().type == "cpu") {
    EXPECT_EQ(textures.arrays_of(&scene::PbrMaterial::base_color_texture), 0x1fu);
  }
}

TEST(Textures, OfOthersSpaceOrWrappingAreNot) {
  std::vector<scene::Texture> all(4, grey_texture(8, 8, 100));
  all[1].srgb = true;
  all[2].repeat_u = false;
  all[3].repeat_v = false;
  const scene::GpuTextures textures(test::device(), all, {});
  for (int32_t a = 0; a < 4; ++a)
    for (int32_t b = 0; b < a; ++b) EXPECT_NE(textures.reference(a) >> 16, textures.reference(b) >> 16);
}

TEST(Textures, ShadersAskAFewImagesOneByOne) { expect_greys(12); }

TEST(Textures, ShadersPickAmongManyImagesByNumber) {
  const uint32_t many = shared::most_tried_arrays + 4;
  const scene::Scene scene = strips(many);
  const scene::GpuScene gpu(test::device(), scene, {.acceleration_structure = false});
  EXPECT_EQ(gpu.textures().arrays_of(&scene::PbrMaterial::base_color_texture), 0u);
  expect_greys(many);
}

TEST(Textures, OfSceneWithoutAnyCanStillBeBound) {
  TinyScene tiny;
  tiny.quad({-4, -4, 0}, {4, -4, 0}, {4, 4, 0}, {-4, 4, 0});
  CameraRig rig(tiny.build(), test::plain_light(), test::plain_camera(16), test::lambertian());
  EXPECT_GT(rig.shoot(test::look({0, 0, 3.9}, 0.0, 90.0)).hdr[0], 0.0f);
}

}  // namespace
}  // namespace greatx
