// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "renderer/camera/streaks.h"

#include <algorithm>
#include <cmath>

#include "shaders/shared/random.h"

namespace greatx::render {

namespace {

constexpr double nearest_drop_m = 0.3;
constexpr double most_drops = 262144.0;

}  // namespace

StreakPass::StreakPass(const SceneLighting& lighting, const CameraDesc& desc)
    : rain_(desc.rain), scope_(desc.name + " streaks") {
  gpu::Device& device = lighting.scene().device();
  gpu::ComputeDesc draw;
  draw.shader = "camera/streaks.comp";
  draw.bindings = {{shared::streaks_seen_binding, VK_DESCRIPTOR_TYPE_STORAGE_BUFFER},
                   {shared::streaks_depth_binding, VK_DESCRIPTOR_TYPE_STORAGE_BUFFER}};
  draw.push_constant_bytes = sizeof(shared::StreakConstants);
  draw_ = gpu::ComputePipeline(device, draw, scope_);
  gpu::ComputeDesc add;
  add.shader = "camera/streaks_add.comp";
  add.bindings = {{shared::streaks_depth_binding, VK_DESCRIPTOR_TYPE_STORAGE_BUFFER},
                  {shared::streaks_color_binding, VK_DESCRIPTOR_TYPE_STORAGE_BUFFER}};
  add.push_constant_bytes = sizeof(shared::StreakConstants);
  add_ = gpu::ComputePipeline(device, add, scope_ + " added");
  depth_ = gpu::Buffer(device, sizeof(uint32_t) * desc.width * desc.height, gpu::Memory::device, scope_);

  const FallingDrops& drops = lighting.drops();
  // The drops fill a pyramid of the widened picture up to the reach.
  const double margin = double{shared::streak_margin}, volume = margin * desc.width / desc.fx * margin *
                                                                desc.height / desc.fy *
                                                                std::pow(drops.reach_m, 3.0) / 3.0;
  constants_.count = static_cast<uint32_t>(std::lround(std::min(drops.per_m3 * volume, most_drops)));
  constants_.focal = vec2(desc.fx, desc.fy);
  constants_.center = vec2(desc.cx, desc.cy);
  constants_.width = desc.width;
  constants_.height = desc.height;
  constants_.nearest = float(nearest_drop_m);
  constants_.reach = float(drops.reach_m);
  constants_.slope = float(drops.slope_per_mm);
  constants_.shutter = float(rain_.shutter_s);
  constants_.glow = vec3(drops.radiance / stored_luminance(desc, lighting));
}

void StreakPass::record(gpu::TickSlot& slot, const CameraView& view, const gpu::Buffer& seen,
                        const gpu::Buffer& color, const FrameNumber& frame) {
  shared::StreakConstants constants = constants_;
  const auto seen_from = [&](const dvec3& d) {
    return vec3(glm::dot(view.right, d), glm::dot(view.down, d), glm::dot(view.forward, d));
  };
  constants.fall = seen_from({0.0, 0.0, -1.0});
  constants.drift = seen_from(-frame.velocity);
  const shared::uvec4 key = shared::philox4x32(
      shared::uvec4(rain_.stream, frame.sequence, 0x7261696eu, 0u),
      shared::uvec2(static_cast<uint32_t>(rain_.seed), static_cast<uint32_t>(rain_.seed >> 32)));
  constants.key = shared::uvec2(key.x, key.y);
  constants.tick = static_cast<uint32_t>(frame.tick);

  gpu::Cmd& cmd = *slot.cmd;
  const auto scope = cmd.scope(scope_);
  cmd.barrier(gpu::sync::compute_read, gpu::sync::transfer_write);
  cmd.fill(depth_.slice(), 0);
  cmd.barrier(gpu::sync::transfer_write, gpu::sync::compute);
  cmd.barrier(gpu::sync::compute, gpu::sync::compute);  // waits for colour and what is seen
  cmd.bind(draw_);
  cmd.push({gpu::Descriptor::buffer(shared::streaks_seen_binding, seen),
            gpu::Descriptor::buffer(shared::streaks_depth_binding, depth_)});
  cmd.constants(constants);
  cmd.dispatch_linear(constants.count, shared::streak_group_size);
  cmd.barrier(gpu::sync::compute, gpu::sync::compute);
  cmd.bind(add_);
  cmd.push({gpu::Descriptor::buffer(shared::streaks_depth_binding, depth_),
            gpu::Descriptor::buffer(shared::streaks_color_binding, color)});
  cmd.constants(constants);
  cmd.dispatch_linear(uint64_t{constants.width} * constants.height, shared::streak_group_size);
  cmd.barrier(gpu::sync::compute, gpu::sync::compute);
}

}  // namespace greatx::render
