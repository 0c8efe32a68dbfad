// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "renderer/camera/cells.h"

#include "shaders/shared/reproject.h"

namespace greatx::render {

CellPass::CellPass(const SceneLighting& lighting, const CameraDesc& desc)
    : lighting_(&lighting), width_(desc.width), height_(desc.height), scope_(desc.name + " cells") {
  gpu::ComputeDesc compute;
  compute.shader = "camera/cells.comp";
  compute.bindings = SceneLighting::surface_bindings();
  for (const uint32_t slot : {shared::cells_seen_binding, shared::cells_luminance_binding,
                              shared::cells_to_binding, shared::cells_ids_binding})
    compute.bindings.push_back({slot, VK_DESCRIPTOR_TYPE_STORAGE_BUFFER});
  compute.push_constant_bytes = sizeof(shared::CameraConstants);
  compute.specialization.resize(shared::shade_spec_count);
  compute.specialization[shared::cells_spec_outlines] = desc.msaa == 1;
  compute.specialization[shared::spec_triangle_address] = lighting.surfaces().by_address();
  pipeline_ = gpu::ComputePipeline(lighting.scene().device(), compute, scope_);
}

void CellPass::record(gpu::TickSlot& slot, const gpu::Buffer& seen, const gpu::Buffer& luminance,
                      const gpu::Buffer& cells) {
  gpu::Cmd& cmd = *slot.cmd;
  const auto scope = cmd.scope(scope_);
  cmd.barrier(gpu::sync::compute, gpu::sync::compute);
  std::vector<gpu::Descriptor> descriptors = lighting_->surface_descriptors();
  for (const auto& [binding, buffer] : {std::pair{shared::cells_seen_binding, &seen},
                                        {shared::cells_luminance_binding, &luminance},
                                        {shared::cells_to_binding, &cells},
                                        {shared::cells_ids_binding, &lighting_->surfaces().triangle_ids()}})
    descriptors.push_back(gpu::Descriptor::buffer(binding, *buffer));
  cmd.bind(pipeline_);
  cmd.push(descriptors);
  cmd.constants(constants_);
  cmd.dispatch(shared::tiles_along(width_), shared::tiles_along(height_));
}

}  // namespace greatx::render
