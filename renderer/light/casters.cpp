// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "renderer/light/casters.h"

#include "core/error.h"
#include "shaders/shared/camera.h"

namespace greatx::render {

namespace {
constexpr VkFormat caster_format = VK_FORMAT_D32_SFLOAT;
}  // namespace

bool has_mask(const scene::Scene& scene, uint32_t primitive) {
  return scene.materials[scene.primitives[primitive].material].pbr.alpha_mode == scene::AlphaMode::mask;
}

gpu::GraphicsPipeline caster_pipeline(const scene::GpuScene& scene, bool moving, bool masked) {
  gpu::GraphicsDesc desc;
  desc.vertex_shader = moving ? "camera/caster_moving.vert" : "camera/caster.vert";
  if (masked) {
    desc.fragment_shader = "camera/shadow_mask.frag";
    desc.textures = &scene.textures().table();
    desc.specialization = {scene.textures().arrays_of(&scene::MaterialTextures::base_color)};
  }
  desc.bindings = scene::GpuScene::raster_bindings();
  desc.push_constant_bytes = sizeof(shared::CasterConstants);
  desc.depth_format = caster_format;
  return gpu::GraphicsPipeline(
      scene.device(), desc,
      fmt::format("{} caster{}", moving ? "moving" : "static", masked ? " masked" : ""));
}

std::vector<gpu::Descriptor> static_caster_descriptors(const scene::GpuScene& scene) {
  std::vector<gpu::Descriptor> found;
  for (const gpu::Descriptor& descriptor : scene.raster_descriptors())
    if (descriptor.slot == shared::scene_binding) found.push_back(descriptor);
  GREATX_CHECK(found.size() == 1, "the scene has no descriptor {}", shared::scene_binding);
  return found;
}

void draw_casters(gpu::Cmd& cmd, const scene::Scene& scene, std::span<const uint32_t> primitives) {
  for (const uint32_t index : primitives) {
    const scene::Primitive& primitive = scene.primitives[index];
    cmd.draw_indexed(primitive.first_index, primitive.index_count, index);
  }
}

gpu::Image caster_map(gpu::Device& device, uint32_t size, VkImageUsageFlags extra_usage,
                      std::string_view name) {
  return gpu::Image(
      device,
      {.format = caster_format,
       .width = size,
       .height = size,
       .usage = VK_IMAGE_USAGE_DEPTH_STENCIL_ATTACHMENT_BIT | VK_IMAGE_USAGE_SAMPLED_BIT | extra_usage},
      name);
}

gpu::Sampler caster_sampler(gpu::Device& device, std::string_view name) {
  return gpu::Sampler(
      device, {.linear = true, .repeat_u = false, .repeat_v = false, .compare_greater_or_equal = true}, name);
}

}  // namespace greatx::render
