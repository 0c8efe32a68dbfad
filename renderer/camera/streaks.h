// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Draws falling drops as streaks (docs/light.md). The drops of a picture are a function of (seed, sensor,
// sequence, tick), independent from picture to picture: between two of them a drop falls out of sight.
#pragma once

#include <string>

#include "gpu/tick_ring.h"
#include "renderer/camera/camera.h"
#include "renderer/camera/camera_view.h"
#include "shaders/shared/weather.h"

namespace greatx::render {

class StreakPass {
 public:
  StreakPass(const SceneLighting& lighting, const CameraDesc& desc);
  /// Records the streaks of a picture before `color`.
  void record(gpu::TickSlot& slot, const CameraView& view, const gpu::Buffer& seen, const gpu::Buffer& color,
              const FrameNumber& frame);
  /// The number of drops that a picture draws.
  uint32_t count() const { return constants_.count; }

 private:
  RainView rain_;
  std::string scope_;
  gpu::ComputePipeline draw_, add_;
  gpu::Buffer depth_;  ///< optical depth of the streaks, in whole numbers
  shared::StreakConstants constants_{};
};

}  // namespace greatx::render
