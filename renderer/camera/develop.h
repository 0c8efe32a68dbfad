// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// The last stage of a camera: from radiance and what the pixels see to arrays in the tick's readback arena.
#pragma once

#include <string>
#include <vector>

#include "gpu/tick_ring.h"
#include "renderer/camera/camera.h"

namespace greatx::render {

class DevelopPass {
 public:
  /// Builds the pipeline for the outputs of `desc`. `lighting` outlives this.
  DevelopPass(const SceneLighting& lighting, const CameraDesc& desc);
  /// `color` and `seen` as CameraPass keeps them (hdr_image, seen_image).
  void record(gpu::TickSlot& slot, gpu::Image& color, gpu::Image& seen, const FrameNumber& frame);
  /// What was recorded into `slot`, once its submission is done.
  CameraImages collect(const gpu::TickSlot& slot) const;

 private:
  struct Readback {
    gpu::Slice rgb, hdr, depth, instance, semantic, material;
  };

  const SceneLighting* lighting_;
  CameraDesc desc_;
  gpu::ComputePipeline pipeline_;
  std::vector<Readback> readbacks_;  ///< by slot
  std::string scope_;
};

}  // namespace greatx::render
