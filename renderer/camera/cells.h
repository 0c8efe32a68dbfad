// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Keeps of a picture what an event camera needs to look at it again from other instants
// (shaders/shared/reproject.h).
#pragma once

#include <string>

#include "gpu/cmd.h"
#include "gpu/tick_ring.h"
#include "renderer/camera/camera.h"
#include "shaders/shared/camera.h"

namespace greatx::render {

class CellPass {
 public:
  CellPass(const SceneLighting& lighting, const CameraDesc& desc);
  /// Remembers the view of the picture that was recorded last.
  void see(const shared::CameraConstants& constants) { constants_ = constants; }
  /// `luminance` is that of one sample a pixel, before edges are smoothed. `cells` is written.
  void record(gpu::TickSlot& slot, const gpu::Buffer& seen, const gpu::Buffer& luminance,
              const gpu::Buffer& cells);

 private:
  const SceneLighting* lighting_;
  uint32_t width_, height_;
  std::string scope_;
  gpu::ComputePipeline pipeline_;
  shared::CameraConstants constants_{};
};

}  // namespace greatx::render
