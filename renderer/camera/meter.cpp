// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "renderer/camera/meter.h"

#include <algorithm>
#include <cmath>

#include "core/units.h"
#include "renderer/camera/camera.h"

namespace greatx::render {

double metered_ev100(double luminance_cd_m2) { return std::log2(luminance_cd_m2 * (100.0 / 12.5)); }

double anchor_luminance(double ground_illuminance_lux) {
  constexpr double grey = 0.18, least_lux = 1.0;
  return saturation_luminance(metered_ev100(grey / pi * std::max(ground_illuminance_lux, least_lux)));
}

MeterPass::MeterPass(gpu::Device& device, const CameraDesc& desc, double stored_luminance)
    : scope_(desc.name + " meter") {
  gpu::ComputeDesc histogram;
  histogram.shader = "camera/meter.comp";
  histogram.bindings = {{shared::meter_color_binding, VK_DESCRIPTOR_TYPE_STORAGE_BUFFER}};
  histogram.push_constant_bytes = sizeof(shared::MeterConstants);
  histogram_ = gpu::ComputePipeline(device, histogram, scope_);
  gpu::ComputeDesc result;
  result.shader = "camera/meter_result.comp";
  result.push_constant_bytes = sizeof(shared::MeterConstants);
  result_ = gpu::ComputePipeline(device, result, scope_ + " result");
  bins_ = gpu::Buffer(device, shared::meter_bins * sizeof(shared::MeterBin), gpu::Memory::device, scope_);

  uint32_t step = 1;
  while (uint64_t{desc.width / step} * (desc.height / step) > shared::meter_most_samples &&
         step < std::min(desc.width, desc.height))
    ++step;
  constants_.bins = bins_.address();
  constants_.step = step;
  constants_.columns = desc.width / step;
  constants_.rows = desc.height / step;
  constants_.width = desc.width;
  constants_.stored_luminance = static_cast<float>(stored_luminance);
  constants_.compensation_ev = static_cast<float>(desc.compensation_ev);
}

gpu::Slice MeterPass::record(gpu::TickSlot& slot, const gpu::Buffer& color) {
  const gpu::Slice result = slot.readback.allocate_for<shared::MeterResult>(1);
  shared::MeterConstants constants = constants_;
  constants.result = result.address;

  gpu::Cmd& cmd = *slot.cmd;
  const auto scope = cmd.scope(scope_);
  // waits for the copy of the picture before
  cmd.barrier(gpu::sync::compute_read, gpu::sync::transfer_write);
  cmd.fill(bins_.slice(), 0);
  cmd.barrier(gpu::sync::transfer_write, gpu::sync::compute);
  cmd.barrier(gpu::sync::compute_write, gpu::sync::compute_read);  // waits for the colour
  cmd.bind(histogram_);
  cmd.push({gpu::Descriptor::buffer(shared::meter_color_binding, color)});
  cmd.constants(constants);
  cmd.dispatch_linear(uint64_t{constants.columns} * constants.rows, shared::meter_group_size);
  cmd.barrier(gpu::sync::compute_write, gpu::sync::compute_read);
  cmd.bind(result_);
  cmd.constants(constants);
  cmd.dispatch(1);
  cmd.barrier(gpu::sync::compute_write, gpu::sync::compute_read);
  return result;
}

}  // namespace greatx::render
