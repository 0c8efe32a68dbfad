// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "renderer/camera/glare.h"

#include <algorithm>

#include "core/error.h"
#include "shaders/shared/camera.h"

namespace greatx::render {

GlarePass::GlarePass(const SceneLighting& lighting, const CameraDesc& desc)
    : width_(desc.width), height_(desc.height), share_(desc.glare), scope_(desc.name + " glare") {
  if (!(desc.glare > 0.0 && desc.glare < 1.0))
    throw_user_error("camera {}: glare: expected a share between 0 and 1, found {}", desc.name, desc.glare);
  gpu::Device& device = lighting.scene().device();
  gpu::ComputeDesc compute;
  compute.shader = "camera/glare.comp";
  compute.bindings = {{shared::glare_from_binding, VK_DESCRIPTOR_TYPE_STORAGE_BUFFER},
                      {shared::glare_to_binding, VK_DESCRIPTOR_TYPE_STORAGE_BUFFER}};
  compute.push_constant_bytes = sizeof(shared::GlareConstants);
  pipeline_ = gpu::ComputePipeline(device, compute, scope_);
  // The coarsest level still has a few pixels along its shorter side.
  constexpr uint32_t least_side = 6;
  uint32_t width = width_, height = height_;
  do {
    width = (width + 1) / 2;
    height = (height + 1) / 2;
    levels_.push_back({width, height,
                       gpu::Buffer(device, sizeof(uvec2) * width * height, gpu::Memory::device,
                                   fmt::format("{} level {}", scope_, levels_.size()))});
  } while (std::min(width, height) >= 2 * least_side && levels_.size() < shared::glare_most_levels);
}

void GlarePass::step(gpu::Cmd& cmd, const gpu::Buffer& from, const gpu::Buffer& to,
                     shared::GlareConstants constants) {
  cmd.push({gpu::Descriptor::buffer(shared::glare_from_binding, from),
            gpu::Descriptor::buffer(shared::glare_to_binding, to)});
  cmd.constants(constants);
  cmd.dispatch((constants.to_width + shared::shade_group_width - 1) / shared::shade_group_width,
               (constants.to_height + shared::shade_group_height - 1) / shared::shade_group_height);
  cmd.barrier(gpu::sync::compute, gpu::sync::compute);
}

void GlarePass::record(gpu::TickSlot& slot, const gpu::Buffer& color) {
  gpu::Cmd& cmd = *slot.cmd;
  const auto scope = cmd.scope(scope_);
  cmd.barrier(gpu::sync::compute, gpu::sync::compute);
  cmd.bind(pipeline_);
  const auto count = static_cast<uint32_t>(levels_.size());
  for (uint32_t k = 0; k < count; ++k) {
    const uint32_t width = k == 0 ? width_ : levels_[k - 1].width,
                   height = k == 0 ? height_ : levels_[k - 1].height;
    step(cmd, k == 0 ? color : levels_[k - 1].color, levels_[k].color,
         {width, height, levels_[k].width, levels_[k].height, 0.0f, 0});
  }
  // Level k becomes the mean of the levels from k on.
  for (uint32_t k = count - 1; k-- > 0;)
    step(cmd, levels_[k + 1].color, levels_[k].color,
         {levels_[k + 1].width, levels_[k + 1].height, levels_[k].width, levels_[k].height,
          1.0f / float(count - k), 1});
  step(cmd, levels_[0].color, color,
       {levels_[0].width, levels_[0].height, width_, height_, float(1.0 - share_), 1});
}

}  // namespace greatx::render
