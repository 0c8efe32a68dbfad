// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Plans the images that hold a scene's textures. Textures of one size, colour space and wrapping are layers
// of one array image. Two rules keep the number of these images small and reduce two look-ups for a surface
// to one:
//   - A small texture that repeats is laid side by side until it is as large as a larger one. (A CPU driver
//     calls its sampling code once for every array image that a group of pixels needs.)
//   - The roughness of an opaque surface is stored in the alpha of its base colour.
// Both rules preserve the texels of the textures at every mip level.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "scene/description/scene.h"

namespace greatx::scene {

/// Identifies a texture in shaders (shaders/shared/scene.h, texture_array_shift): its array, how often it is
/// laid side by side, and its layer; -1: none.
using TextureReference = int32_t;

/// Holds the textures of a material.
struct MaterialTextures {
  TextureReference base_color = -1, metallic_roughness = -1, normal = -1, emissive = -1;
  /// Whether the roughness is stored in the alpha of the base colour. metallic_roughness is then -1.
  bool roughness_in_alpha = false;
  float metallic = 1.0f;  ///< with roughness_in_alpha: the one value of the texture, a factor
};

struct TextureLayers {
  struct Layer {
    int32_t texture = -1;    ///< index into Scene::textures
    int32_t roughness = -1;  ///< the texture whose green becomes the alpha; -1: none
  };
  struct Array {
    bool srgb = true, repeat_u = true, repeat_v = true;
    uint32_t width = 0, height = 0;  ///< size of a layer
    std::vector<Layer> layers;
  };
  std::vector<Array> arrays;
  std::vector<MaterialTextures> materials;  ///< [materials]
};

struct TextureLayerLimits {
  uint32_t layers = 2048;  ///< most layers of an array
  /// Maximum size of all layers that are laid side by side, without their mips; 0: no layer is.
  uint64_t tiled_bytes = 0;
};

/// Plans the layers of the textures that materials name.
TextureLayers plan_texture_layers(std::span<const Texture> textures, std::span<const Material> materials,
                                  const TextureLayerLimits& limits);

/// Returns the RGBA8 rows of a layer of `array`, top row first.
std::vector<uint8_t> texels_of(const TextureLayers::Array& array, const TextureLayers::Layer& layer,
                               std::span<const Texture> textures);

}  // namespace greatx::scene
