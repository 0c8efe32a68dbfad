// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Smooths the edges of a picture that was shaded once per pixel (shaders/camera/edges.comp.glsl). On a CPU
// this costs a quarter of four samples per pixel. Objects thinner than a pixel stay as coarse as without it,
// but for thin lines (renderer/camera/thin_lines.h).
#pragma once

#include <string>

#include "gpu/tick_ring.h"
#include "renderer/camera/camera.h"

namespace greatx::render {

struct CameraView;

class EdgePass {
 public:
  /// Smooths colour, luminance or both, as `desc` delivers them. `lighting` outlives this. `lines`:
  /// pictures may have thin lines, which have their shares already.
  EdgePass(const SceneLighting& lighting, const CameraDesc& desc, bool lines);
  /// Names a picture, the view of its pixels (CameraPass::seen), the buffers of its smooth version, and the
  /// words of its thin lines (null: it has none).
  struct Pictures {
    const PictureBuffers& from;
    const gpu::Buffer& seen;
    const PictureBuffers& to;
    const gpu::Slice* lines;
  };
  /// `pixels` lists those that look through the view (CameraFace::pixels); null: all do.
  void record(gpu::TickSlot& slot, const CameraView& view, const gpu::Descriptor& lens,
              const Pictures& pictures, const gpu::Slice* pixels);

 private:
  const SceneLighting* lighting_;
  uint32_t width_, height_;
  gpu::ComputePipeline pipeline_;
  std::string scope_;
};

}  // namespace greatx::render
