// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "renderer/light/shadow_raster.h"

#include <fmt/format.h>

#include "shaders/shared/camera.h"

namespace greatx::render {

gpu::Image shadow_map(gpu::Device& device, uint32_t size, std::string_view name) {
  return gpu::Image(device,
                    {.format = shadow_map_format,
                     .width = size,
                     .height = size,
                     .usage = VK_IMAGE_USAGE_DEPTH_STENCIL_ATTACHMENT_BIT | VK_IMAGE_USAGE_SAMPLED_BIT},
                    name);
}

bool has_holes(const scene::Scene& scene, uint32_t primitive) {
  return scene.materials[scene.primitives[primitive].material].pbr.alpha_mode == scene::AlphaMode::mask;
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

}  // namespace greatx::render
