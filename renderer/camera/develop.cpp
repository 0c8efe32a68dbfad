// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "renderer/camera/develop.h"

#include "core/error.h"
#include "shaders/shared/camera.h"

namespace greatx::render {

namespace {

template <typename T>
std::vector<T> copied(const gpu::Slice& slice, size_t count) {
  if (slice.buffer == VK_NULL_HANDLE) return {};
  const std::span<T> values = slice.as<T>();
  return std::vector<T>(values.begin(), values.begin() + static_cast<ptrdiff_t>(count));
}

}  // namespace

DevelopPass::DevelopPass(const SceneLighting& lighting, const CameraDesc& desc)
    : lighting_(&lighting), desc_(desc), scope_(desc.name + " develop") {
  gpu::ComputeDesc develop;
  develop.shader = "camera/develop.comp";
  develop.bindings = scene::GpuScene::bindings(false);
  develop.bindings.push_back({shared::develop_color_binding, VK_DESCRIPTOR_TYPE_STORAGE_IMAGE});
  develop.bindings.push_back({shared::develop_seen_binding, VK_DESCRIPTOR_TYPE_STORAGE_IMAGE});
  develop.bindings.push_back(
      {shared::develop_triangle_primitives_binding, VK_DESCRIPTOR_TYPE_STORAGE_BUFFER});
  develop.push_constant_bytes = sizeof(shared::DevelopConstants);
  develop.specialization.resize(shared::develop_spec_count);
  develop.specialization[shared::develop_spec_rgb] = desc_.outputs.rgb;
  develop.specialization[shared::develop_spec_hdr] = desc_.outputs.hdr;
  develop.specialization[shared::develop_spec_depth] = desc_.outputs.depth;
  develop.specialization[shared::develop_spec_instance] = desc_.outputs.instance;
  develop.specialization[shared::develop_spec_semantic] = desc_.outputs.semantic;
  develop.specialization[shared::develop_spec_material] = desc_.outputs.material;
  pipeline_ = gpu::ComputePipeline(lighting_->scene().device(), develop, desc_.name + " develop");
}

void DevelopPass::record(gpu::TickSlot& slot, gpu::Image& color, gpu::Image& seen, const FrameNumber&) {
  const CameraOutputs& outputs = desc_.outputs;
  const size_t groups =
      (size_t(desc_.width) * desc_.height + shared::develop_pixels - 1) / shared::develop_pixels;
  const auto words = [&](bool wanted, size_t per_group) {
    return wanted ? slot.readback.allocate(4 * per_group * groups) : gpu::Slice{};
  };
  Readback readback;
  readback.rgb = words(outputs.rgb, 3);
  readback.hdr = words(outputs.hdr, 12);
  readback.depth = words(outputs.depth, 4);
  readback.instance = words(outputs.instance, 4);
  readback.semantic = words(outputs.semantic, 1);
  readback.material = words(outputs.material, 2);
  if (readbacks_.size() <= slot.index) readbacks_.resize(slot.index + 1);
  readbacks_[slot.index] = readback;

  gpu::Cmd& cmd = *slot.cmd;
  const auto scope = cmd.scope(scope_);
  cmd.transition(color, gpu::ImageUse::storage);
  cmd.transition(seen, gpu::ImageUse::storage);
  cmd.bind(pipeline_);
  std::vector<gpu::Descriptor> descriptors = lighting_->scene().raster_descriptors();
  descriptors.push_back(gpu::Descriptor::storage(shared::develop_color_binding, color));
  descriptors.push_back(gpu::Descriptor::storage(shared::develop_seen_binding, seen));
  descriptors.push_back(gpu::Descriptor::buffer(shared::develop_triangle_primitives_binding,
                                                lighting_->surfaces().triangle_primitives()));
  cmd.push(descriptors);
  shared::DevelopConstants constants{};
  constants.rgb = readback.rgb.address;
  constants.hdr = readback.hdr.address;
  constants.depth = readback.depth.address;
  constants.instance = readback.instance.address;
  constants.semantic = readback.semantic.address;
  constants.material = readback.material.address;
  constants.width = desc_.width;
  constants.height = desc_.height;
  constants.radiance_scale = float(stored_luminance(desc_, *lighting_));
  cmd.constants(constants);
  cmd.dispatch(static_cast<uint32_t>((groups + shared::develop_group_size - 1) / shared::develop_group_size));
}

CameraImages DevelopPass::collect(const gpu::TickSlot& slot) const {
  GREATX_CHECK(slot.index < readbacks_.size(), "camera {}: nothing was recorded into slot {}", desc_.name,
               slot.index);
  const Readback& from = readbacks_[slot.index];
  const size_t count = size_t(desc_.width) * desc_.height;
  CameraImages images;
  images.width = desc_.width;
  images.height = desc_.height;
  images.ev100 = float(desc_.exposure_ev100);
  images.rgb = copied<uint8_t>(from.rgb, 3 * count);
  images.hdr = copied<float>(from.hdr, 3 * count);
  images.depth = copied<float>(from.depth, count);
  images.instance = copied<uint32_t>(from.instance, count);
  images.semantic = copied<uint8_t>(from.semantic, count);
  images.material = copied<uint16_t>(from.material, count);
  return images;
}

}  // namespace greatx::render
