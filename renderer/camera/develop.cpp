// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "renderer/camera/develop.h"

#include <bit>
#include <cmath>
#include <limits>

#include "core/error.h"
#include "shaders/shared/film.h"

namespace greatx::render {

namespace {

template <typename T>
std::vector<T> copied(const gpu::Slice& slice, size_t count) {
  if (slice.buffer == VK_NULL_HANDLE) return {};
  const std::span<T> values = slice.as<T>();
  return std::vector<T>(values.begin(), values.begin() + static_cast<ptrdiff_t>(count));
}

/// Returns the invocations of the developing pass.
uint32_t groups_of(const CameraDesc& desc) {
  return (desc.width * desc.height + shared::develop_pixels - 1) / shared::develop_pixels;
}

}  // namespace

shared::SensorConstants sensor_constants(const SensorNoise& noise, const FrameNumber& frame) {
  GREATX_CHECK(frame.tick >= 0 && frame.tick <= std::numeric_limits<uint32_t>::max(), "tick {}", frame.tick);
  // Each sensor and sequence has a key of its own, so that the counter is left for ticks and pixels.
  const shared::uvec4 key = shared::philox4x32(
      shared::uvec4(noise.stream, frame.sequence, 0x66696c6du, 0u),
      shared::uvec2(static_cast<uint32_t>(noise.seed), static_cast<uint32_t>(noise.seed >> 32)));
  return {static_cast<float>(noise.full_well_e), static_cast<float>(noise.read_noise_e),
          static_cast<float>((1u << noise.bits) - 1), static_cast<uint32_t>(frame.tick),
          shared::uvec2(key.x, key.y)};
}

DevelopPass::DevelopPass(const SceneLighting& lighting, const CameraDesc& desc)
    : lighting_(&lighting), desc_(desc), scope_(desc.name + " develop") {
  check();
  gpu::Device& device = lighting_->scene().device();
  const bool rgb = desc_.outputs.rgb;
  const bool vignetting = rgb && desc_.vignetting.any();
  if (rgb && desc_.automatic_exposure) meter_.emplace(device, desc_, stored_luminance(desc_, lighting));
  if (vignetting) {
    std::vector<float> field = flat_field(desc_.vignetting, lens_geometry(desc_));
    field.resize(size_t{groups_of(desc_)} * shared::develop_pixels, 1.0f);
    flat_field_ = gpu::upload_buffer(device, std::as_bytes(std::span(field)), desc_.name + " flat field");
  }
  gpu::ComputeDesc develop;
  develop.shader = "camera/develop.comp";
  develop.bindings = {{shared::develop_color_binding, VK_DESCRIPTOR_TYPE_STORAGE_BUFFER},
                      {shared::develop_seen_binding, VK_DESCRIPTOR_TYPE_STORAGE_BUFFER},
                      {shared::develop_triangle_ids_binding, VK_DESCRIPTOR_TYPE_STORAGE_BUFFER}};
  develop.push_constant_bytes = sizeof(shared::DevelopConstants);
  develop.specialization.resize(shared::develop_spec_count);
  develop.specialization[shared::develop_spec_rgb] = desc_.outputs.rgb;
  develop.specialization[shared::develop_spec_hdr] = desc_.outputs.hdr;
  develop.specialization[shared::develop_spec_depth] = desc_.outputs.depth;
  develop.specialization[shared::develop_spec_instance] = desc_.outputs.instance;
  develop.specialization[shared::develop_spec_semantic] = desc_.outputs.semantic;
  develop.specialization[shared::develop_spec_material] = desc_.outputs.material;
  develop.specialization[shared::develop_spec_metered] = meter_.has_value();
  develop.specialization[shared::develop_spec_flat_field] = vignetting;
  develop.specialization[shared::develop_spec_noise] = rgb && desc_.noise.has_value();
  if (const ChromaticAberration& chromatic = desc_.chromatic; chromatic.any()) {
    const auto bits = [](double value) { return std::bit_cast<uint32_t>(static_cast<float>(value)); };
    develop.specialization[shared::develop_spec_chromatic] = rgb || desc_.outputs.hdr;
    develop.specialization[shared::develop_spec_chromatic_x] = bits(desc_.cx);
    develop.specialization[shared::develop_spec_chromatic_y] = bits(desc_.cy);
    develop.specialization[shared::develop_spec_chromatic_red] = bits(1.0 / chromatic.red);
    develop.specialization[shared::develop_spec_chromatic_blue] = bits(1.0 / chromatic.blue);
  }
  pipeline_ = gpu::ComputePipeline(device, develop, scope_);
}

void DevelopPass::check() const {
  const auto require = [&](bool holds, const char* field, const char* expected, double found) {
    if (!holds) throw_user_error("camera {}: {}: expected {}, found {}", desc_.name, field, expected, found);
  };
  require(desc_.chromatic.red > 0.5 && desc_.chromatic.red < 2.0, "chromatic.red", "0.5 to 2",
          desc_.chromatic.red);
  require(desc_.chromatic.blue > 0.5 && desc_.chromatic.blue < 2.0, "chromatic.blue", "0.5 to 2",
          desc_.chromatic.blue);
  require(std::abs(desc_.compensation_ev) <= 10.0, "compensation_ev", "-10 to 10", desc_.compensation_ev);
  if (!desc_.noise) return;
  const SensorNoise& noise = *desc_.noise;
  require(noise.full_well_e >= 1.0 && noise.full_well_e <= 1e7, "noise.full_well_e", "1 to 1e7 electrons",
          noise.full_well_e);
  require(noise.read_noise_e >= 0.0 && noise.read_noise_e <= noise.full_well_e, "noise.read_noise_e",
          "0 to the full well's electrons", noise.read_noise_e);
  require(noise.bits >= 1 && noise.bits <= 16, "noise.bits", "1 to 16", noise.bits);
}

DevelopPass::Readback DevelopPass::allocate(gpu::TickSlot& slot) const {
  const CameraOutputs& outputs = desc_.outputs;
  const auto bytes = [&](bool wanted, size_t per_pixel) {
    return wanted ? slot.readback.allocate(per_pixel * shared::develop_pixels * groups_of(desc_))
                  : gpu::Slice{};
  };
  Readback readback;
  readback.rgb = bytes(outputs.rgb, 3);
  readback.hdr = bytes(outputs.hdr, 12);
  readback.depth = bytes(outputs.depth, 4);
  readback.instance = bytes(outputs.instance, 4);
  readback.semantic = bytes(outputs.semantic, 1);
  readback.material = bytes(outputs.material, 2);
  return readback;
}

void DevelopPass::record(gpu::TickSlot& slot, const gpu::Buffer& color, const gpu::Buffer& seen,
                         const FrameNumber& frame) {
  Readback readback = allocate(slot);
  if (meter_) readback.exposure = meter_->record(slot, color);
  if (readbacks_.size() <= slot.index) readbacks_.resize(slot.index + 1);
  readbacks_[slot.index] = readback;

  gpu::Cmd& cmd = *slot.cmd;
  const auto scope = cmd.scope(scope_);
  cmd.barrier(gpu::sync::compute_write, gpu::sync::compute_read);
  cmd.bind(pipeline_);
  cmd.push(
      {gpu::Descriptor::buffer(shared::develop_color_binding, color),
       gpu::Descriptor::buffer(shared::develop_seen_binding, seen),
       gpu::Descriptor::buffer(shared::develop_triangle_ids_binding, lighting_->surfaces().triangle_ids())});
  shared::DevelopConstants constants{};
  constants.rgb = readback.rgb.address;
  constants.hdr = readback.hdr.address;
  constants.depth = readback.depth.address;
  constants.instance = readback.instance.address;
  constants.semantic = readback.semantic.address;
  constants.material = readback.material.address;
  constants.exposure = readback.exposure.address;
  constants.flat_field = flat_field_.address();
  constants.width = desc_.width;
  constants.height = desc_.height;
  constants.radiance_scale = static_cast<float>(stored_luminance(desc_, *lighting_));
  if (desc_.noise) constants.sensor = sensor_constants(*desc_.noise, frame);
  cmd.constants(constants);
  cmd.dispatch_linear(groups_of(desc_), shared::develop_group_size);
}

CameraImages DevelopPass::collect(const gpu::TickSlot& slot) const {
  GREATX_CHECK(slot.index < readbacks_.size(), "camera {}: nothing was recorded into slot {}", desc_.name,
               slot.index);
  const Readback& from = readbacks_[slot.index];
  const size_t count = size_t(desc_.width) * desc_.height;
  CameraImages images;
  images.width = desc_.width;
  images.height = desc_.height;
  images.ev100 =
      meter_ ? from.exposure.as<shared::MeterResult>()[0].ev100 : static_cast<float>(desc_.exposure_ev100);
  images.rgb = copied<uint8_t>(from.rgb, 3 * count);
  images.hdr = copied<float>(from.hdr, 3 * count);
  images.depth = copied<float>(from.depth, count);
  images.instance = copied<uint32_t>(from.instance, count);
  images.semantic = copied<uint8_t>(from.semantic, count);
  images.material = copied<uint16_t>(from.material, count);
  return images;
}

}  // namespace greatx::render
