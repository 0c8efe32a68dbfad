// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Implements the last stage of a camera. It turns radiance and the view of the pixels into arrays in the
// tick's readback arena. docs/film.md describes exposure, vignetting, sensor noise and tone curve.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "gpu/tick_ring.h"
#include "renderer/camera/camera.h"
#include "renderer/camera/meter.h"

namespace greatx::render {

/// Returns the constants from which shaders draw a sensor's noise. `frame.tick` must fit 32 bits.
shared::SensorConstants sensor_constants(const SensorNoise& noise, const FrameNumber& frame);

class DevelopPass {
 public:
  /// Builds the pipelines for the outputs and effects of `desc`. `lighting` outlives this. Throws UserError
  /// naming the camera if the vignetting, the noise or the compensation is not sensible.
  DevelopPass(const SceneLighting& lighting, const CameraDesc& desc);
  /// `color` and `seen` are the buffers of CameraPass (PictureBuffers::color, CameraPass::seen).
  void record(gpu::TickSlot& slot, const gpu::Buffer& color, const gpu::Buffer& seen,
              const FrameNumber& frame);
  /// Returns the arrays that were recorded into `slot`, once its submission is done.
  CameraImages collect(const gpu::TickSlot& slot) const;

 private:
  struct Readback {
    gpu::Slice rgb, hdr, depth, instance, semantic, material, exposure;
  };
  void check() const;
  Readback allocate(gpu::TickSlot& slot) const;

  const SceneLighting* lighting_;
  CameraDesc desc_;
  gpu::ComputePipeline pipeline_;
  std::optional<MeterPass> meter_;
  gpu::Buffer flat_field_;           ///< empty without vignetting
  std::vector<Readback> readbacks_;  ///< by slot
  std::string scope_;
};

}  // namespace greatx::render
