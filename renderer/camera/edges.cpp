// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "renderer/camera/edges.h"

#include "renderer/camera/camera_view.h"
#include "renderer/camera/faces.h"
#include "shaders/shared/camera.h"

namespace greatx::render {

EdgePass::EdgePass(const SceneLighting& lighting, const CameraDesc& desc, bool lines)
    : lighting_(&lighting), width_(desc.width), height_(desc.height), scope_(desc.name + " edges") {
  gpu::ComputeDesc edges;
  edges.shader = "camera/edges.comp";
  edges.bindings = SceneLighting::surface_bindings();
  edges.bindings.push_back({shared::lens_binding, VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER});
  edges.bindings.push_back({shared::face_pixels_binding, VK_DESCRIPTOR_TYPE_STORAGE_BUFFER});
  for (const uint32_t slot :
       {shared::edges_seen_binding, shared::edges_from_binding, shared::edges_to_binding,
        shared::edges_luminance_from_binding, shared::edges_luminance_to_binding})
    edges.bindings.push_back({slot, VK_DESCRIPTOR_TYPE_STORAGE_BUFFER});
  edges.push_constant_bytes = sizeof(shared::CameraConstants);
  edges.specialization.resize(shared::shade_spec_count);
  edges.specialization[shared::spec_color] = desc.outputs.color();
  edges.specialization[shared::spec_triangle_address] = lighting.surfaces().by_address();
  edges.specialization[shared::spec_luminance] = desc.outputs.luminance;
  edges.specialization[shared::spec_distortion] = desc.distortion.any();
  edges.specialization[shared::spec_faces] = has_faces(desc);
  edges.specialization[shared::spec_thin_lines] = lines;
  edges.specialization[shared::spec_band_rows] = desc.bands > 0 ? rows_of_band(desc) : 0;
  pipeline_ = gpu::ComputePipeline(lighting.scene().device(), edges, scope_);
}

void EdgePass::record(gpu::TickSlot& slot, const CameraView& view, const gpu::Descriptor& lens,
                      const Pictures& pictures, const gpu::Slice* pixels) {
  gpu::Cmd& cmd = *slot.cmd;
  const auto scope = cmd.scope(scope_);
  cmd.barrier(gpu::sync::compute, gpu::sync::compute);
  std::vector<gpu::Descriptor> descriptors = lighting_->surface_descriptors();
  descriptors.push_back(lens);
  descriptors.push_back(gpu::Descriptor::buffer(shared::face_pixels_binding, pixels ? *pixels
                                                                             : pictures.lines
                                                                                 ? *pictures.lines
                                                                                 : pictures.seen.slice()));
  for (const auto& [binding, buffer] : {std::pair{shared::edges_seen_binding, &pictures.seen},
                                        {shared::edges_from_binding, &pictures.from.color},
                                        {shared::edges_to_binding, &pictures.to.color},
                                        {shared::edges_luminance_from_binding, &pictures.from.luminance},
                                        {shared::edges_luminance_to_binding, &pictures.to.luminance}})
    descriptors.push_back(gpu::Descriptor::buffer(binding, *buffer));
  cmd.bind(pipeline_);
  cmd.push(descriptors);
  cmd.constants(view.constants);
  if (pixels)
    return cmd.dispatch_linear(pixels->size / sizeof(shared::FacePixel),
                               shared::shade_group_width * shared::shade_group_height);
  cmd.dispatch((width_ + shared::shade_group_width - 1) / shared::shade_group_width,
               (height_ + shared::shade_group_height - 1) / shared::shade_group_height);
}

}  // namespace greatx::render
