// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "renderer/event/reprojection.h"

#include <utility>

#include "renderer/event/event_pass.h"

namespace greatx::render {

namespace {

/// A pixel without smoothed edges takes in a point: its outlines are that sharp.
constexpr float sharp = 1e4f;

}  // namespace

Reprojection::Reprojection(const scene::GpuScene& scene, const EventDesc& desc,
                           const std::vector<uint32_t>& specialization)
    : width_(desc.width),
      height_(desc.height),
      grid_(desc.instants),
      most_px_(static_cast<float>(desc.wanted)),
      sharpness_(desc.smooth_edges ? 1.0f : sharp) {
  gpu::Device& device = scene.device();
  const size_t pixels = size_t{width_} * height_;
  const auto buffer = [&](size_t bytes, const char* what) {
    return gpu::Buffer(device, bytes, gpu::Memory::device, desc.name + " " + what);
  };
  for (gpu::Buffer& cells : cells_) cells = buffer(pixels * shared::cell_quads * sizeof(glm::uvec4), "cells");
  for (gpu::Buffer& tiles : tiles_)
    tiles = buffer(sizeof(glm::vec4) * shared::tiles_along(width_) * shared::tiles_along(height_), "tiles");
  const bool extra = desc.cutoff_hz > 0.0 || desc.refractory_s > 0.0;
  after_ = buffer(pixels * sizeof(glm::uvec2), "pixels after");
  extra_after_ = buffer(extra ? pixels * sizeof(glm::uvec2) : 0, "pixels' delays after");
  counts_ = buffer(pixels * sizeof(uint32_t), "pixels' events");
  gpu::ComputeDesc compute;
  for (uint32_t slot = 0; slot <= shared::event_reproject_binding; ++slot)
    compute.bindings.push_back({slot, VK_DESCRIPTOR_TYPE_STORAGE_BUFFER});
  compute.push_constant_bytes = sizeof(shared::EventConstants);
  compute.specialization = specialization;
  for (const auto& [pipeline, name] : {std::pair{&tile_luminance_, "tiles"},
                                       {&bound_, "bound"},
                                       {&reproject_, "reproject"},
                                       {&rank_, "rank"}}) {
    compute.shader = std::string("event/") + name + ".comp";
    *pipeline = gpu::ComputePipeline(device, compute, desc.name + " " + name);
  }
}

gpu::Slice Reprojection::upload(gpu::TickSlot& slot, const PixelPaths& paths, const gpu::Slice& of_bodies,
                                bool replay) const {
  shared::ReprojectInterval interval{};
  for (const uint32_t picture : {0u, 1u}) {
    interval.cells[picture] = cells_[picture == 0 ? 1 - newest_ : newest_].address();
    interval.tiles[picture] = tiles_[picture].address();
  }
  interval.paths = of_bodies.address;
  interval.grid = grid_;
  interval.bodies = paths.bodies;
  interval.exact_world = paths.exact_world;
  interval.most_px = most_px_;
  interval.sharpness = sharpness_;
  interval.replay = replay;
  std::copy(paths.world.begin(), paths.world.end(), interval.world);
  return slot.upload.put(std::span<const shared::ReprojectInterval>(&interval, 1));
}

void Reprojection::dispatch(gpu::Cmd& cmd) const {
  cmd.dispatch(shared::tiles_along(width_), shared::tiles_along(height_));
}

void Reprojection::record(gpu::TickSlot& slot, std::vector<gpu::Descriptor> descriptors,
                          const shared::EventConstants& constants, const PixelPaths& paths,
                          gpu::Buffer& pixels, gpu::Buffer& extra) {
  gpu::Cmd& cmd = *slot.cmd;
  for (gpu::Descriptor& descriptor : descriptors) {  // the steps before have swapped these
    if (descriptor.slot == shared::event_pixel_binding)
      descriptor = gpu::Descriptor::buffer(descriptor.slot, pixels);
    if (descriptor.slot == shared::event_extra_binding)
      descriptor = gpu::Descriptor::buffer(descriptor.slot, extra);
  }
  for (const auto& [binding, of] : {std::pair{shared::event_after_binding, &after_},
                                    {shared::event_extra_after_binding, &extra_after_},
                                    {shared::event_counts_binding, &counts_}})
    descriptors.push_back(gpu::Descriptor::buffer(binding, *of));
  const gpu::Slice of_bodies = slot.upload.put(std::span(paths.of_bodies));
  const auto run = [&](const gpu::ComputePipeline& pipeline, bool replay) {
    std::vector<gpu::Descriptor> all = descriptors;
    all.push_back(
        gpu::Descriptor::buffer(shared::event_reproject_binding, upload(slot, paths, of_bodies, replay)));
    cmd.barrier(gpu::sync::compute, gpu::sync::compute);
    cmd.bind(pipeline);
    cmd.push(all);
    cmd.constants(constants);
  };
  const uint32_t tiles = shared::tiles_along(width_) * shared::tiles_along(height_);
  run(tile_luminance_, false);
  cmd.dispatch_linear(tiles, shared::event_group_size);
  run(bound_, false);
  cmd.dispatch_linear(tiles, shared::event_group_size);
  run(reproject_, false);
  dispatch(cmd);
  run(rank_, false);
  cmd.dispatch(1);
  run(reproject_, true);
  dispatch(cmd);
  std::swap(pixels, after_);
  std::swap(extra, extra_after_);
}

}  // namespace greatx::render
