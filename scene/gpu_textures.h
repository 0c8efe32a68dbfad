// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// The scene's textures on the GPU: those of one size, colour space and wrapping are layers of one array image. A CPU
// driver calls its sampling code once per image and pixel: of few images, known when the shader is compiled, it is as
// fast as of one.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "gpu/pipeline.h"
#include "gpu/resources.h"
#include "scene/scene.h"

namespace greatx::scene {

class GpuTextures {
 public:
  GpuTextures() = default;
  /// Those that `materials` name.
  GpuTextures(gpu::Device& device, std::span<const Texture> textures, std::span<const Material> materials);

  /// The arrays: sampler2DArray [arrays] in set 1, binding 0.
  const gpu::TextureTable& table() const { return table_; }
  /// What shaders know a texture of the scene by: array << 16 | layer. None (-1): -1.
  int32_t reference(int32_t texture) const;
  /// The arrays that textures of one use are in, a bit each, for a specialization constant (shaders/lib/textures.glsl):
  /// the shader asks for them one by one. 0: it picks one by a number that differs between its lanes.
  uint32_t arrays_of(int32_t PbrMaterial::*use) const;

 private:
  std::vector<gpu::Image> arrays_;
  std::vector<gpu::Sampler> samplers_;
  gpu::TextureTable table_;
  std::vector<int32_t> references_;  ///< of each texture
  std::span<const Material> materials_;
  bool tries_arrays_ = false;
};

}  // namespace greatx::scene
