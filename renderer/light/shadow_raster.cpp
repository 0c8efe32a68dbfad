// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "renderer/light/shadow_raster.h"

#include <algorithm>

#include <fmt/format.h>

#include "core/error.h"

namespace greatx::render {

namespace {
constexpr VkFormat shadow_map_format = VK_FORMAT_D32_SFLOAT;
}  // namespace

gpu::Image shadow_map(gpu::Device& device, uint32_t size, std::string_view name, VkImageUsageFlags also) {
  return gpu::Image(
      device,
      {.format = shadow_map_format,
       .width = size,
       .height = size,
       .usage = VK_IMAGE_USAGE_DEPTH_STENCIL_ATTACHMENT_BIT | VK_IMAGE_USAGE_SAMPLED_BIT | also},
      name);
}

gpu::Sampler shadow_sampler(gpu::Device& device, std::string_view name, bool repeats) {
  return gpu::Sampler(
      device, {.linear = true, .repeat_u = repeats, .repeat_v = repeats, .compare_greater_or_equal = true},
      name);
}

gpu::GraphicsPipeline shadow_pipeline(const scene::GpuScene& scene, gpu::GraphicsDesc desc, bool masked,
                                      std::string_view name) {
  desc.specialization = {0u, masked ? 1u : 0u};
  if (masked) {
    desc.fragment_shader = "camera/shadow_mask.frag";
    desc.textures = &scene.textures().table();
    desc.specialization[shared::shadow_spec_base_color_arrays] =
        scene.textures().arrays_of(&scene::MaterialTextures::base_color);
  }
  for (const gpu::Binding& binding : scene::GpuScene::raster_bindings()) desc.bindings.push_back(binding);
  desc.depth_format = shadow_map_format;
  return gpu::GraphicsPipeline(scene.device(), desc, fmt::format("{}{}", name, masked ? " masked" : ""));
}

gpu::GraphicsPipeline pane_shadow_pipeline(const scene::GpuScene& scene, gpu::GraphicsDesc desc,
                                           std::string_view name) {
  desc.fragment_shader = "camera/shadow_pane.frag";
  desc.bindings.push_back({shared::material_records_binding, VK_DESCRIPTOR_TYPE_STORAGE_BUFFER});
  for (const gpu::Binding& binding : scene::GpuScene::raster_bindings()) desc.bindings.push_back(binding);
  desc.depth_format = shadow_map_format;
  return gpu::GraphicsPipeline(scene.device(), desc, fmt::format("{} of panes", name));
}

gpu::GraphicsPipeline pane_caster_pipeline(const scene::GpuScene& scene, std::string_view name) {
  gpu::GraphicsDesc desc;
  desc.vertex_shader = "camera/pane_caster.vert";
  desc.push_constant_bytes = sizeof(shared::CasterConstants);
  return pane_shadow_pipeline(scene, desc, name);
}

gpu::GraphicsPipeline caster_pipeline(const scene::GpuScene& scene, bool moving, bool masked,
                                      std::string_view name) {
  gpu::GraphicsDesc desc;
  desc.vertex_shader = moving ? "camera/caster_moving.vert" : "camera/caster.vert";
  desc.push_constant_bytes = sizeof(shared::CasterConstants);
  return shadow_pipeline(scene, desc, masked, name);
}

MovingCasters moving_casters(const scene::GpuScene& scene, bool alpha_mask) {
  MovingCasters moving{body_casters(scene.scene(), alpha_mask), {}, {}};
  const auto any = [&](std::vector<CasterRange> BodyCaster::*ranges) {
    return std::ranges::any_of(moving.bodies,
                               [&](const BodyCaster& body) { return !(body.*ranges).empty(); });
  };
  if (any(&BodyCaster::opaque)) moving.opaque = caster_pipeline(scene, true, false, "moving caster");
  if (any(&BodyCaster::masked)) moving.masked = caster_pipeline(scene, true, true, "moving caster");
  return moving;
}

std::vector<gpu::Descriptor> static_caster_descriptors(const scene::GpuScene& scene,
                                                       const gpu::Buffer* panes) {
  std::vector<gpu::Descriptor> found;
  for (const gpu::Descriptor& descriptor : scene.raster_descriptors())
    if (descriptor.slot == shared::scene_binding) found.push_back(descriptor);
  GREATX_CHECK(found.size() == 1, "the scene has no descriptor {}", shared::scene_binding);
  if (panes != nullptr) found.push_back(gpu::Descriptor::buffer(shared::material_records_binding, *panes));
  return found;
}

void draw_casters(gpu::Cmd& cmd, std::span<const CasterRange> ranges) {
  for (const CasterRange& range : ranges)
    cmd.draw_indexed(range.first_index, range.index_count, range.primitive);
}

void draw_casters(gpu::Cmd& cmd, const scene::Scene& scene, std::span<const uint32_t> primitives) {
  for (const uint32_t index : primitives) {
    const scene::Primitive& primitive = scene.primitives[index];
    cmd.draw_indexed(primitive.first_index, primitive.index_count, index);
  }
}

}  // namespace greatx::render
