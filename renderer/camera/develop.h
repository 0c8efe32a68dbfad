// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// The last stage of a camera: from radiance and what the pixels see to arrays in the tick's readback arena. Exposure,
// vignetting, sensor noise, tone curve: docs/film.md.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "gpu/tick_ring.h"
#include "renderer/camera/camera.h"
#include "renderer/camera/meter.h"

namespace greatx::render {

/// What a sensor's noise is drawn from, as shaders read it. `frame.tick` must fit 32 bits.
shared::SensorConstants sensor_constants(const SensorNoise& noise, const FrameNumber& frame);

class DevelopPass {
 public:
  /// Builds the pipelines for the outputs and effects of `desc`. `lighting` outlives this. Throws UserError naming the
  /// camera if the vignetting, the noise or the compensation is not sensible.
  DevelopPass(const SceneLighting& lighting, const CameraDesc& desc);
  /// `color` and `seen` as CameraPass keeps them (PictureBuffers::color, CameraPass::seen).
  void record(gpu::TickSlot& slot, const gpu::Buffer& color, const gpu::Buffer& seen,
              const FrameNumber& frame);
  /// What was recorded into `slot`, once its submission is done.
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
