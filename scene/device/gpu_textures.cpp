// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "scene/device/gpu_textures.h"

#include <algorithm>
#include <bit>
#include <cstring>

#include <fmt/format.h>

#include "gpu/cmd.h"
#include "shaders/shared/scene.h"

namespace greatx::scene {

namespace {

/// Maximum memory for textures laid side by side.
constexpr uint64_t most_tiled_bytes = 48u << 20;

gpu::Image upload(gpu::Device& device, const TextureLayers::Array& array, std::span<const Texture> textures,
                  std::string_view name) {
  gpu::ImageDesc desc;
  desc.format = array.srgb ? VK_FORMAT_R8G8B8A8_SRGB : VK_FORMAT_R8G8B8A8_UNORM;
  desc.width = array.width;
  desc.height = array.height;
  desc.mip_levels = static_cast<uint32_t>(std::bit_width(std::max(array.width, array.height)));
  desc.layers = static_cast<uint32_t>(array.layers.size());
  desc.usage = VK_IMAGE_USAGE_SAMPLED_BIT | VK_IMAGE_USAGE_TRANSFER_DST_BIT | VK_IMAGE_USAGE_TRANSFER_SRC_BIT;
  gpu::Image image(device, desc, name);
  const size_t bytes = size_t{4} * array.width * array.height;
  const gpu::Buffer staging(device, bytes * array.layers.size(), gpu::Memory::upload, "texture staging");
  for (size_t i = 0; i < array.layers.size(); ++i)
    std::memcpy(staging.slice().mapped + bytes * i, texels_of(array, array.layers[i], textures).data(),
                bytes);
  gpu::submit_setup(device, [&](gpu::Cmd& cmd) {
    cmd.transition(image, gpu::ImageUse::transfer_target, true);
    cmd.copy(staging.slice(), image);
    cmd.generate_mipmaps(image);
  });
  return image;
}

}  // namespace

GpuTextures::GpuTextures(gpu::Device& device, std::span<const Texture> textures,
                         std::span<const Material> materials) {
  // A CPU driver calls its sampling code once for all lanes if the compiled shader knows the image, and once
  // for each lane otherwise.
  const bool cpu = device.info().type == "cpu";
  TextureLayerLimits limits;
  limits.layers = std::min(device.limits().maxImageArrayLayers, shared::texture_most_layers);
  limits.tiled_bytes = cpu ? most_tiled_bytes : 0;
  TextureLayers layers = plan_texture_layers(textures, materials, limits);
  materials_ = std::move(layers.materials);
  // The table needs one image at least, which nothing samples if there are no textures.
  const Texture white{.width = 1, .height = 1, .rgba = {255, 255, 255, 255}};
  if (layers.arrays.empty()) {
    layers.arrays.push_back({.width = 1, .height = 1, .layers = {{.texture = 0}}});
    textures = std::span(&white, 1);
  }
  std::vector<VkDescriptorImageInfo> infos;
  for (const TextureLayers::Array& array : layers.arrays) {
    const std::string name = fmt::format("textures of {} x {}", array.width, array.height);
    const gpu::SamplerDesc sampler{.repeat_u = array.repeat_u, .repeat_v = array.repeat_v, .mipmaps = true};
    arrays_.push_back(upload(device, array, textures, name));
    samplers_.emplace_back(device, sampler, name);
    infos.push_back(
        {samplers_.back().handle(), arrays_.back().view(), VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL});
  }
  const bool any_number = device.info().has_texture_table();
  if (!any_number && arrays_.size() > shared::most_tried_arrays)
    throw_user_error(
        "the scene's textures: expected at most {} different sizes, colour spaces and wrappings on '{}', "
        "which has no table of textures (greatx info), found {}",
        shared::most_tried_arrays, device.info().name, arrays_.size());
  tries_arrays_ = arrays_.size() <= 1 || !any_number || (cpu && arrays_.size() <= shared::most_tried_arrays);
  table_ = gpu::TextureTable(device, infos, tries_arrays_, "scene textures");
}

uint32_t GpuTextures::arrays_of(TextureReference MaterialTextures::*use) const {
  uint32_t arrays = 0;
  if (!tries_arrays_) return arrays;
  for (const MaterialTextures& material : materials_)
    if (material.*use >= 0) arrays |= 1u << (material.*use >> shared::texture_array_shift);
  return arrays;
}

}  // namespace greatx::scene
