// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Checks the images that hold textures: layers of their own size, textures side by side in larger layers, and
// roughness in the alpha of colours.
#include "scene/device/texture_layers.h"

#include <gtest/gtest.h>

#include "shaders/shared/scene.h"

namespace greatx::scene {
namespace {

Texture texture_of(uint32_t width, uint32_t height, bool srgb = false) {
  Texture texture;
  texture.width = width;
  texture.height = height;
  texture.srgb = srgb;
  for (uint32_t i = 0; i < 4 * width * height; ++i)
    texture.rgba.push_back(static_cast<uint8_t>(7 * i + width));
  return texture;
}

Material painted(int32_t color, int32_t metallic_roughness = -1) {
  Material material;
  material.pbr.base_color_texture = color;
  material.pbr.metallic_roughness_texture = metallic_roughness;
  return material;
}

uint32_t array_of(TextureReference r) { return static_cast<uint32_t>(r) >> shared::texture_array_shift; }
uint32_t layer_of(TextureReference r) { return static_cast<uint32_t>(r) & (shared::texture_most_layers - 1); }
uint32_t tiles_u(TextureReference r) {
  return static_cast<uint32_t>(r) >> shared::texture_tiles_u_shift & 15u;
}
uint32_t tiles_v(TextureReference r) {
  return static_cast<uint32_t>(r) >> shared::texture_tiles_v_shift & 15u;
}

std::vector<Material> one_each(size_t count) {
  std::vector<Material> materials;
  for (size_t i = 0; i < count; ++i) materials.push_back(painted(static_cast<int32_t>(i)));
  return materials;
}

TEST(TextureLayers, OfOneSizeAreLayersOfOneArray) {
  const std::vector<Texture> textures{texture_of(8, 4), texture_of(4, 8), texture_of(8, 4)};
  const TextureLayers plan = plan_texture_layers(textures, one_each(3), {});
  ASSERT_EQ(plan.arrays.size(), 2u);
  EXPECT_EQ(array_of(plan.materials[0].base_color), array_of(plan.materials[2].base_color));
  EXPECT_NE(layer_of(plan.materials[0].base_color), layer_of(plan.materials[2].base_color));
  EXPECT_NE(array_of(plan.materials[0].base_color), array_of(plan.materials[1].base_color));
}

TEST(TextureLayers, OfOtherSpaceOrWrappingAreNot) {
  std::vector<Texture> textures(4, texture_of(8, 8));
  textures[1].srgb = true;
  textures[2].repeat_u = false;
  textures[3].repeat_v = false;
  EXPECT_EQ(plan_texture_layers(textures, one_each(4), {.tiled_bytes = 1u << 20}).arrays.size(), 4u);
}

TEST(TextureLayers, ThatNoMaterialNamesAreNot) {
  const std::vector<Texture> textures{texture_of(8, 8), texture_of(4, 4)};
  const TextureLayers plan = plan_texture_layers(textures, std::vector{painted(1), painted(-1)}, {});
  ASSERT_EQ(plan.arrays.size(), 1u);
  EXPECT_EQ(plan.arrays[0].width, 4u);
  EXPECT_EQ(plan.materials[1].base_color, -1);
}

TEST(TextureLayers, FillArrayAfterArray) {
  const std::vector<Texture> textures(5, texture_of(4, 4));
  const TextureLayers plan = plan_texture_layers(textures, one_each(5), {.layers = 2});
  ASSERT_EQ(plan.arrays.size(), 3u);
  EXPECT_EQ(plan.arrays[2].layers.size(), 1u);
  EXPECT_EQ(layer_of(plan.materials[4].base_color), 0u);
}

TEST(TextureLayers, SmallOnesLieSideBySide) {
  const std::vector<Texture> textures{texture_of(8, 4), texture_of(4, 4), texture_of(2, 1), texture_of(6, 4)};
  const TextureLayers plan = plan_texture_layers(textures, one_each(4), {.tiled_bytes = 1u << 20});
  ASSERT_EQ(plan.arrays.size(), 2u);  // a size of 6 fits no other size
  const TextureReference small = plan.materials[2].base_color;
  EXPECT_EQ(array_of(small), array_of(plan.materials[0].base_color));
  EXPECT_EQ(tiles_u(small), 2u);
  EXPECT_EQ(tiles_v(small), 2u);
  EXPECT_EQ(tiles_u(plan.materials[1].base_color), 1u);
  EXPECT_EQ(tiles_v(plan.materials[1].base_color), 0u);
  const TextureLayers::Array& array = plan.arrays[array_of(small)];
  const std::vector<uint8_t> texels = texels_of(array, array.layers[layer_of(small)], textures);
  ASSERT_EQ(texels.size(), 4u * 8 * 4);
  for (size_t i = 0; i < texels.size(); ++i)
    EXPECT_EQ(texels[i], textures[2].rgba[i / 4 % 8 % 2 * 4 + i % 4]) << i;
}

TEST(TextureLayers, LieSideBySideOnlyIfTheyRepeatAndThereIsRoom) {
  std::vector<Texture> textures{texture_of(8, 8), texture_of(4, 4)};
  EXPECT_EQ(plan_texture_layers(textures, one_each(2), {.tiled_bytes = 4 * 64}).arrays.size(), 1u);
  EXPECT_EQ(plan_texture_layers(textures, one_each(2), {.tiled_bytes = 4 * 64 - 1}).arrays.size(), 2u);
  for (Texture& texture : textures) texture.repeat_v = false;
  EXPECT_EQ(plan_texture_layers(textures, one_each(2), {.tiled_bytes = 1u << 20}).arrays.size(), 2u);
}

TEST(TextureLayers, RoughnessStandsInTheAlphaOfItsColour) {
  std::vector<Texture> textures{texture_of(4, 2, true), texture_of(4, 2)};
  // the same metallic value everywhere
  for (size_t i = 2; i < textures[1].rgba.size(); i += 4) textures[1].rgba[i] = 51;
  const TextureLayers plan = plan_texture_layers(textures, std::vector{painted(0, 1), painted(0)}, {});
  ASSERT_EQ(plan.arrays.size(), 1u);
  const MaterialTextures& all = plan.materials[0];
  EXPECT_TRUE(all.roughness_in_alpha);
  EXPECT_EQ(all.metallic_roughness, -1);
  EXPECT_FLOAT_EQ(all.metallic, 0.2f);
  EXPECT_FALSE(plan.materials[1].roughness_in_alpha);
  EXPECT_NE(plan.materials[1].base_color, all.base_color);
  const std::vector<uint8_t> texels =
      texels_of(plan.arrays[0], plan.arrays[0].layers[layer_of(all.base_color)], textures);
  for (size_t i = 0; i < texels.size(); ++i)
    EXPECT_EQ(texels[i], i % 4 == 3 ? textures[1].rgba[i - 2] : textures[0].rgba[i]) << i;
}

TEST(TextureLayers, RoughnessStandsApartWhereAlphaOrMetalIsNeeded) {
  const std::vector<Texture> textures{texture_of(4, 2, true), texture_of(4, 2), texture_of(8, 2)};
  Material masked = painted(0, 1);
  masked.pbr.alpha_mode = AlphaMode::mask;
  masked.pbr.metallic = 0.0f;
  Material dull = painted(0, 1);
  dull.pbr.metallic = 0.0f;
  const TextureLayers plan =
      plan_texture_layers(textures, std::vector{masked, painted(0, 1), painted(0, 2), dull}, {});
  EXPECT_FALSE(plan.materials[0].roughness_in_alpha);
  EXPECT_FALSE(plan.materials[1].roughness_in_alpha);  // its metallic values differ
  EXPECT_FALSE(plan.materials[2].roughness_in_alpha);  // another size
  EXPECT_TRUE(plan.materials[3].roughness_in_alpha);   // its metallic factor is 0
  EXPECT_GE(plan.materials[0].metallic_roughness, 0);
}

}  // namespace
}  // namespace greatx::scene
