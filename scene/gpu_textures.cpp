// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "scene/gpu_textures.h"

#include <algorithm>
#include <bit>
#include <compare>
#include <cstring>
#include <map>

#include <fmt/format.h>

#include "gpu/cmd.h"
#include "shaders/shared/scene.h"

namespace greatx::scene {

namespace {

struct Kind {
  bool srgb, repeat_u, repeat_v;
  uint32_t width, height;
  auto operator<=>(const Kind&) const = default;
};

gpu::Image upload(gpu::Device& device, const Kind& kind, std::span<const Texture* const> layers,
                  std::string_view name) {
  gpu::ImageDesc desc;
  desc.format = kind.srgb ? VK_FORMAT_R8G8B8A8_SRGB : VK_FORMAT_R8G8B8A8_UNORM;
  desc.width = kind.width;
  desc.height = kind.height;
  desc.mip_levels = static_cast<uint32_t>(std::bit_width(std::max(kind.width, kind.height)));
  desc.layers = static_cast<uint32_t>(layers.size());
  desc.usage = VK_IMAGE_USAGE_SAMPLED_BIT | VK_IMAGE_USAGE_TRANSFER_DST_BIT | VK_IMAGE_USAGE_TRANSFER_SRC_BIT;
  gpu::Image image(device, desc, name);
  const size_t bytes = layers[0]->rgba.size();
  const gpu::Buffer staging(device, bytes * layers.size(), gpu::Memory::upload, "texture staging");
  for (size_t i = 0; i < layers.size(); ++i)
    std::memcpy(staging.slice().mapped + bytes * i, layers[i]->rgba.data(), bytes);
  gpu::submit_setup(device, [&](gpu::Cmd& cmd) {
    cmd.transition(image, gpu::ImageUse::transfer_target, true);
    cmd.copy(staging.slice(), image);
    cmd.generate_mipmaps(image);
  });
  return image;
}

}  // namespace

GpuTextures::GpuTextures(gpu::Device& device, std::span<const Texture> textures,
                         std::span<const Material> materials)
    : references_(textures.size()), materials_(materials) {
  std::map<Kind, std::vector<size_t>> kinds;
  for (size_t i = 0; i < textures.size(); ++i) {
    const Texture& t = textures[i];
    kinds[{t.srgb, t.repeat_u, t.repeat_v, t.width, t.height}].push_back(i);
  }
  const size_t most_layers = device.limits().maxImageArrayLayers;
  for (const auto& [kind, all] : kinds) {
    for (size_t first = 0; first < all.size(); first += most_layers) {
      std::vector<const Texture*> layers;
      for (size_t i = first; i < std::min(first + most_layers, all.size()); ++i) {
        references_[all[i]] = static_cast<int32_t>(arrays_.size() << 16 | layers.size());
        layers.push_back(&textures[all[i]]);
      }
      const std::string name = fmt::format("textures of {} x {}", kind.width, kind.height);
      arrays_.push_back(upload(device, kind, layers, name));
      samplers_.emplace_back(
          device, gpu::SamplerDesc{.repeat_u = kind.repeat_u, .repeat_v = kind.repeat_v, .mipmaps = true},
          name);
    }
  }
  std::vector<VkDescriptorImageInfo> infos;
  for (size_t i = 0; i < arrays_.size(); ++i)
    infos.push_back({samplers_[i].handle(), arrays_[i].view(), VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL});
  table_ = gpu::TextureTable(device, infos, "scene textures");
  // A CPU driver asks an image that the compiled shader knows once for all lanes, any other once for each lane.
  const bool cpu = device.info().type == "cpu";
  tries_arrays_ = arrays_.size() == 1 || (cpu && arrays_.size() <= shared::most_tried_arrays);
}

uint32_t GpuTextures::arrays_of(int32_t PbrMaterial::*use) const {
  uint32_t arrays = 0;
  if (!tries_arrays_) return arrays;
  for (const Material& material : materials_)
    if (const int32_t texture = reference(material.pbr.*use); texture >= 0) arrays |= 1u << (texture >> 16);
  return arrays;
}

int32_t GpuTextures::reference(int32_t texture) const {
  return texture < 0 || references_.empty() ? -1 : references_[static_cast<size_t>(texture)];
}

}  // namespace greatx::scene
