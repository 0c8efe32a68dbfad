// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Defines the scene's textures on the GPU, as scene/device/texture_layers.h lays them out: layers of few
// array images. A CPU driver calls its sampling code for each of these images in turn.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "gpu/pipeline.h"
#include "gpu/resources.h"
#include "scene/device/texture_layers.h"

namespace greatx::scene {

class GpuTextures {
 public:
  GpuTextures() = default;
  /// Uploads the textures that `materials` name. Throws UserError if they need more arrays than the device's
  /// shaders can tell apart.
  GpuTextures(gpu::Device& device, std::span<const Texture> textures, std::span<const Material> materials);

  /// Returns the array images: sampler2DArray [arrays] in set 1, binding 0.
  const gpu::TextureTable& table() const { return table_; }
  /// Returns the textures of a material (index into Scene::materials).
  const MaterialTextures& of_material(size_t material) const { return materials_[material]; }
  /// Returns the arrays that hold the textures of one use, one bit each, for a specialization constant
  /// (shaders/lib/textures.glsl). The shader then tests them one by one. With 0 the shader selects an array
  /// by a number that differs between its lanes, or no material has such a texture.
  uint32_t arrays_of(TextureReference MaterialTextures::*use) const;

 private:
  std::vector<gpu::Image> arrays_;
  std::vector<gpu::Sampler> samplers_;
  gpu::TextureTable table_;
  std::vector<MaterialTextures> materials_;
  bool tries_arrays_ = false;
};

}  // namespace greatx::scene
