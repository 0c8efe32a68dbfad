// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Smooth edges of a picture that was shaded once a pixel (shaders/camera/edges.comp.glsl): a quarter of what four samples
// a pixel cost on a CPU. What is thinner than a pixel stays as coarse as without.
#pragma once

#include <string>

#include "gpu/tick_ring.h"
#include "renderer/camera/camera.h"

namespace greatx::render {

struct CameraView;

class EdgePass {
 public:
  /// For colour, luminance or both, as `desc` delivers them. `lighting` outlives this.
  EdgePass(const SceneLighting& lighting, const CameraDesc& desc);
  /// A picture, what its pixels see (CameraPass::seen), and where its smooth version goes.
  struct Pictures {
    const PictureBuffers& from;
    const gpu::Buffer& seen;
    const PictureBuffers& to;
  };
  void record(gpu::TickSlot& slot, const CameraView& view, const gpu::Descriptor& lens,
              const Pictures& pictures);

 private:
  const SceneLighting* lighting_;
  uint32_t width_, height_;
  gpu::ComputePipeline pipeline_;
  std::string scope_;
};

}  // namespace greatx::render
