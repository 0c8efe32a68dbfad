// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "renderer/camera/panes.h"

#include <vector>

#include "shaders/shared/camera.h"
#include "shaders/shared/pane.h"

namespace greatx::render {

namespace {

constexpr VkFormat passes_format = VK_FORMAT_R16G16B16A16_SFLOAT, nearest_format = VK_FORMAT_R32_UINT;

}  // namespace

double pane_reach(const CameraView& view) {
  return double(shared::pane_dark_pixel) / double(glm::length(view.constants.ray_x));
}

PanePass::PanePass(const SceneLighting& lighting, const CameraDesc& desc, const gpu::ComputeDesc& shading,
                   uint32_t width, uint32_t height)
    : lighting_(&lighting), multisampled_(desc.msaa > 1), scope_(desc.name + " panes") {
  gpu::Device& device = lighting.scene().device();
  gpu::GraphicsDesc draw;
  draw.bindings = scene::GpuScene::raster_bindings();
  draw.bindings.push_back({shared::material_records_binding, VK_DESCRIPTOR_TYPE_STORAGE_BUFFER});
  draw.push_constant_bytes = sizeof(shared::CameraConstants);
  draw.depth_format = VK_FORMAT_D32_SFLOAT;
  draw.samples = static_cast<VkSampleCountFlagBits>(desc.msaa);
  draw.vertex_shader = "camera/pane.vert";
  draw.fragment_shader = "camera/pane.frag";
  draw.color_formats = {passes_format};
  draw.depth_write = false;
  draw.multiply = true;
  passes_pipeline_ = gpu::GraphicsPipeline(device, draw, scope_);
  draw.fragment_shader = "camera/visibility.frag";
  draw.color_formats = {nearest_format};
  draw.depth_write = true;
  draw.multiply = false;
  nearest_pipeline_ = gpu::GraphicsPipeline(device, draw, scope_ + ", the nearest");

  gpu::ComputeDesc shade = shading;
  shade.shader = multisampled_ ? "camera/shade_panes_multisampled.comp" : "camera/shade_panes.comp";
  std::erase_if(shade.bindings, [](const gpu::Binding& binding) {
    return binding.slot == shared::shade_color_binding || binding.slot == shared::shade_luminance_binding ||
           binding.slot == shared::shade_seen_binding;
  });
  shade.bindings.push_back({shared::pane_passes_binding, multisampled_
                                                             ? VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER
                                                             : VK_DESCRIPTOR_TYPE_STORAGE_IMAGE});
  shade_ = gpu::ComputePipeline(device, shade, scope_ + " shade");

  const auto image = [&](VkFormat format, const char* what) {
    return gpu::Image(device,
                      {.format = format,
                       .width = width,
                       .height = height,
                       .mip_levels = 1,
                       .samples = static_cast<VkSampleCountFlagBits>(desc.msaa),
                       .usage = VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT |
                                static_cast<VkImageUsageFlags>(multisampled_ ? VK_IMAGE_USAGE_SAMPLED_BIT
                                                                             : VK_IMAGE_USAGE_STORAGE_BIT)},
                      scope_ + what);
  };
  passes_ = image(passes_format, " let through");
  nearest_ = image(nearest_format, ", the nearest");
}

void PanePass::draw(gpu::Cmd& cmd, const CameraView& view, std::span<const DrawPiece> panes,
                    std::span<const uint32_t> order, gpu::Image& depth) {
  const auto scope = cmd.scope(scope_);
  std::vector<gpu::Descriptor> descriptors = lighting_->scene().raster_descriptors();
  descriptors.push_back(
      gpu::Descriptor::buffer(shared::material_records_binding, lighting_->surfaces().materials()));
  const auto pass = [&](const gpu::GraphicsPipeline& with, gpu::Image& to, const VkClearColorValue& clear) {
    cmd.transition(to, gpu::ImageUse::color_target, true);
    // The pass before has written the depth that this one tests.
    cmd.transition(depth, gpu::ImageUse::depth_target);
    gpu::RenderTargets targets;
    targets.color.push_back({.image = &to, .clear = clear});
    targets.depth = &depth;
    targets.keep_depth = true;
    targets.width = view.pinhole.width;
    targets.height = view.pinhole.height;
    cmd.begin_rendering(targets);
    cmd.bind(with);
    cmd.push(descriptors);
    cmd.constants(view.constants);
    for (const uint32_t i : order)
      cmd.draw_range(panes[i].first_index, panes[i].index_count, panes[i].primitive);
    cmd.end_rendering();
    cmd.transition(to, multisampled_ ? gpu::ImageUse::sampled : gpu::ImageUse::storage);
  };
  pass(passes_pipeline_, passes_, {.float32 = {1.0f, 1.0f, 1.0f, 1.0f}});
  pass(nearest_pipeline_, nearest_, {.uint32 = {0, 0, 0, 0}});
}

std::vector<gpu::Descriptor> PanePass::descriptors(const gpu::Sampler& texels) const {
  if (multisampled_)
    return {gpu::Descriptor::sampled(shared::visibility_binding, nearest_, texels),
            gpu::Descriptor::sampled(shared::pane_passes_binding, passes_, texels)};
  return {gpu::Descriptor::storage(shared::visibility_binding, nearest_),
          gpu::Descriptor::storage(shared::pane_passes_binding, passes_)};
}

}  // namespace greatx::render
