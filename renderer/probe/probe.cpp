// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "renderer/probe/probe.h"

namespace greatx::render {

namespace {
constexpr uint32_t rays_slot = shared::first_pass_binding, hits_slot = shared::first_pass_binding + 1;
}

ProbePass::ProbePass(const scene::GpuScene& scene) : scene_(&scene) {
  gpu::ComputeDesc desc;
  scene.prepare_tracing(desc, "probe/rays.comp");
  desc.bindings.push_back({rays_slot, VK_DESCRIPTOR_TYPE_STORAGE_BUFFER});
  desc.bindings.push_back({hits_slot, VK_DESCRIPTOR_TYPE_STORAGE_BUFFER});
  desc.push_constant_bytes = sizeof(shared::ProbeConstants);
  pipeline_ = gpu::ComputePipeline(scene.device(), desc, "probe");
}

gpu::Slice ProbePass::record(gpu::TickSlot& slot, std::span<const shared::ProbeRay> rays,
                             std::optional<uint32_t> excluded_body) const {
  const auto scope = slot.cmd->scope("probe");
  const gpu::Slice in = slot.upload.put(rays);
  const gpu::Slice out = slot.readback.allocate_for<shared::ProbeHit>(rays.size());
  std::vector<gpu::Descriptor> descriptors = scene_->descriptors();
  descriptors.push_back(gpu::Descriptor::buffer(rays_slot, in));
  descriptors.push_back(gpu::Descriptor::buffer(hits_slot, out));
  slot.cmd->bind(pipeline_);
  slot.cmd->push(descriptors);
  const auto count = static_cast<uint32_t>(rays.size());
  slot.cmd->constants(shared::ProbeConstants{count, excluded_body.value_or(~0u)});
  slot.cmd->dispatch_linear(count, shared::probe_workgroup);
  return out;
}

}  // namespace greatx::render
