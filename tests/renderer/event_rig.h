// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Drives an event pass with luminance from a formula, without a camera.
#pragma once

#include <functional>
#include <memory>
#include <vector>

#include "gpu/condition.h"
#include "renderer/event/event_pass.h"
#include "tests/support/gpu_fixture.h"
#include "tests/support/tiny_scene.h"

namespace greatx::test {

/// Returns the luminance of a pixel, cd/m^2, at a time in seconds.
using LuminanceAt = std::function<double(uint32_t column, uint32_t row, double t)>;

inline render::EventDesc plain_events(uint32_t width, uint32_t height, double threshold) {
  render::EventDesc desc;
  desc.width = width;
  desc.height = height;
  desc.threshold_on = desc.threshold_off = threshold;
  desc.dark_cd_m2 = 1e-6;
  desc.substeps = 1;
  return desc;
}

class EventRig {
 public:
  EventRig(const render::EventDesc& desc, LuminanceAt luminance)
      : scene_(TinyScene().quad({0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}).build()),
        gpu_(device(), scene_, {.acceleration_structure = false, .textures = false}),
        pass_(gpu_, desc),
        ring_(device(), 2, 1 << 16, 1 << 20),
        luminance_(std::move(luminance)),
        picture_(device(), sizeof(float) * desc.width * desc.height, gpu::Memory::device, "luminance") {}

  /// Takes `count` samples at the times 0, 1, 2, ... times `interval_ns` and returns their frames.
  std::vector<render::EventFrame> run(int64_t interval_ns, int64_t count, uint32_t sequence = 0) {
    pass_.restart();
    std::vector<render::EventFrame> frames;
    for (int64_t k = 0; k < count; ++k) {
      gpu::TickSlot& slot = ring_.begin();
      pass_.begin(slot, {std::max<int64_t>(k - 1, 0) * interval_ns, k * interval_ns, k, sequence});
      if (k == 0) picture(slot, 0, 0);
      for (uint32_t i = 1; k > 0 && i <= pass_.desc().substeps; ++i) picture(slot, i, pass_.time_ns(i));
      pass_.end(slot, picture_);
      ring_.submit(slot);
      ring_.wait(slot);
      frames.push_back(pass_.collect(slot));
    }
    return frames;
  }

  /// Returns the logarithm of luminance that the pass works with, from the same rounded luminance.
  double signal(uint32_t column, uint32_t row, double t) const {
    return std::log(static_cast<double>(static_cast<float>(luminance_(column, row, t))) +
                    pass_.desc().dark_cd_m2);
  }

 private:
  void picture(gpu::TickSlot& slot, uint32_t index, int64_t t_ns) {
    const uint32_t width = pass_.desc().width, height = pass_.desc().height;
    const gpu::Slice staging = slot.upload.allocate(size_t(width) * height * sizeof(float));
    const std::span<float> values = staging.as<float>();
    for (uint32_t row = 0; row < height; ++row)
      for (uint32_t column = 0; column < width; ++column)
        values[size_t(row) * width + column] =
            static_cast<float>(luminance_(column, row, 1e-9 * double(t_ns)));
    slot.cmd->barrier(gpu::sync::compute_read, gpu::sync::transfer_write);
    slot.cmd->copy(staging, picture_.slice());
    slot.cmd->barrier(gpu::sync::transfer_write, gpu::sync::compute_read);
    const gpu::Condition condition(*slot.cmd, pass_.condition(index));
    pass_.step(slot, index, picture_, nullptr, {});
  }

  scene::Scene scene_;
  scene::GpuScene gpu_;
  render::EventPass pass_;
  gpu::TickRing ring_;
  LuminanceAt luminance_;
  gpu::Buffer picture_;
};

/// Holds an event of one pixel at an absolute time.
struct PixelEvent {
  int64_t t_ns;
  bool on;
};
inline std::vector<PixelEvent> events_of(const std::vector<render::EventFrame>& frames, int64_t interval_ns,
                                         uint32_t column, uint32_t row) {
  std::vector<PixelEvent> events;
  for (size_t k = 1; k < frames.size(); ++k)
    for (size_t i = 0; i < frames[k].size(); ++i)
      if (frames[k].x[i] == column && frames[k].y[i] == row)
        events.push_back({(int64_t(k) - 1) * interval_ns + frames[k].t_ns[i], frames[k].p[i] == 1});
  return events;
}

}  // namespace greatx::test
