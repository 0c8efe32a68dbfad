// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Adds glare: the light that the glass of a lens scatters. A share of each pixel's light goes to a point
// spread that falls with the square of the angle, as disability glare does (W. S. Stiles, "The effect of
// glare on the brightness difference threshold", Proc. R. Soc. B 104 (1929); CIE 146:2002). Every octave of
// the angle then holds the same light, so the spread is the mean of blurred pictures, each twice as wide as
// the one before.
#pragma once

#include <string>
#include <vector>

#include "gpu/tick_ring.h"
#include "renderer/camera/camera.h"
#include "shaders/shared/weather.h"

namespace greatx::render {

class GlarePass {
 public:
  /// Builds the levels. Throws UserError naming the camera if its glare is not in (0, 1).
  GlarePass(const SceneLighting& lighting, const CameraDesc& desc);
  /// Records glare into `color`, the stored radiance of the picture.
  void record(gpu::TickSlot& slot, const gpu::Buffer& color);

 private:
  struct Level {
    uint32_t width = 0, height = 0;
    gpu::Buffer color;  ///< uvec2 [height, width], halves
  };
  void step(gpu::Cmd& cmd, const gpu::Buffer& from, const gpu::Buffer& to, shared::GlareConstants constants);

  uint32_t width_, height_;
  double share_;
  std::string scope_;
  gpu::ComputePipeline pipeline_;
  std::vector<Level> levels_;  ///< from half of the picture's size on
};

}  // namespace greatx::render
