// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "renderer/camera/mirror.h"

#include "renderer/camera/faces.h"
#include "shaders/shared/camera.h"
#include "shaders/shared/weather.h"

namespace greatx::render {

bool wants_mirrors(const CameraEffects& effects, const CameraDesc& desc) {
  return effects.wet_surfaces && effects.specular && desc.outputs.color() && !desc.distortion.any() &&
         !has_faces(desc) && !desc.parts;
}

MirrorPass::MirrorPass(const SceneLighting& lighting, const CameraDesc& desc)
    : width_(desc.width), height_(desc.height), scope_(desc.name + " mirror images") {
  gpu::Device& device = lighting.scene().device();
  gpu::ComputeDesc compute;
  for (const uint32_t slot : {shared::mirror_seen_binding, shared::mirror_from_binding,
                              shared::mirror_words_binding, shared::mirror_images_binding})
    compute.bindings.push_back({slot, VK_DESCRIPTOR_TYPE_STORAGE_BUFFER});
  compute.push_constant_bytes = sizeof(shared::CameraConstants);
  compute.shader = "camera/mirror.comp";
  find_ = gpu::ComputePipeline(device, compute, scope_);
  compute.bindings.push_back({shared::mirror_to_binding, VK_DESCRIPTOR_TYPE_STORAGE_BUFFER});
  compute.shader = "camera/mirror_add.comp";
  add_ = gpu::ComputePipeline(device, compute, scope_ + " added");
  images_ = gpu::Buffer(device, sizeof(uvec2) * desc.width * desc.height, gpu::Memory::device, scope_);
}

void MirrorPass::record(gpu::TickSlot& slot, const CameraView& view, const Buffers& buffers) {
  gpu::Cmd& cmd = *slot.cmd;
  const auto scope = cmd.scope(scope_);
  cmd.barrier(gpu::sync::compute, gpu::sync::compute);
  std::vector<gpu::Descriptor> descriptors{
      gpu::Descriptor::buffer(shared::mirror_seen_binding, buffers.seen),
      gpu::Descriptor::buffer(shared::mirror_from_binding, buffers.from),
      gpu::Descriptor::buffer(shared::mirror_words_binding, buffers.mirrors),
      gpu::Descriptor::buffer(shared::mirror_images_binding, images_)};
  const auto run = [&](const gpu::ComputePipeline& pipeline) {
    cmd.bind(pipeline);
    cmd.push(descriptors);
    cmd.constants(view.constants);
    cmd.dispatch((width_ + shared::shade_group_width - 1) / shared::shade_group_width,
                 (height_ + shared::shade_group_height - 1) / shared::shade_group_height);
  };
  run(find_);
  cmd.barrier(gpu::sync::compute, gpu::sync::compute);
  descriptors.push_back(gpu::Descriptor::buffer(shared::mirror_to_binding, buffers.to));
  run(add_);
}

}  // namespace greatx::render
