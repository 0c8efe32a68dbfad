// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// The scene's textures on the GPU, as scene/device/texture_layers.h lays them out: layers of few array images, which a CPU driver
// calls its sampling code for one by one.
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
  /// Those that `materials` name.
  GpuTextures(gpu::Device& device, std::span<const Texture> textures, std::span<const Material> materials);

  /// The arrays: sampler2DArray [arrays] in set 1, binding 0.
  const gpu::TextureTable& table() const { return table_; }
  /// Those of a material (index into Scene::materials).
  const MaterialTextures& of_material(size_t material) const { return materials_[material]; }
  /// The arrays that textures of one use are in, a bit each, for a specialization constant (shaders/lib/textures.glsl):
  /// the shader asks for them one by one. 0: it picks one by a number that differs between its lanes.
  uint32_t arrays_of(TextureReference MaterialTextures::*use) const;

 private:
  std::vector<gpu::Image> arrays_;
  std::vector<gpu::Sampler> samplers_;
  gpu::TextureTable table_;
  std::vector<MaterialTextures> materials_;
  bool tries_arrays_ = false;
};

}  // namespace greatx::scene
