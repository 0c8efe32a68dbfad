// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Adds mirror images to level films of water and puddles. Mirrored rays are followed through the picture
// (M. McGuire and M. Mara, "Efficient GPU Screen-Space Ray Tracing", JCGT 3(4), 2014), so a mirror shows only
// what the picture shows, without its hidden sides; elsewhere it keeps the sky that shading gave it.
#pragma once

#include <string>
#include <vector>

#include "gpu/tick_ring.h"
#include "renderer/camera/camera.h"
#include "renderer/camera/camera_view.h"

namespace greatx::render {

/// Returns whether water in the camera's pictures shows mirror images: not behind a lens that distorts, not
/// in motion blur, and not in luminance for event cameras, where water mirrors the sky alone.
bool wants_mirrors(const CameraEffects& effects, const CameraDesc& desc);

class MirrorPass {
 public:
  struct Buffers {
    const gpu::Buffer &seen, &from, &mirrors, &to;
  };
  MirrorPass(const SceneLighting& lighting, const CameraDesc& desc);
  /// Records `to` as `from` with mirror images.
  void record(gpu::TickSlot& slot, const CameraView& view, const Buffers& buffers);

 private:
  uint32_t width_, height_;
  std::string scope_;
  gpu::ComputePipeline find_, add_;
  gpu::Buffer images_;  ///< uvec2 [pixels]: what the mirrors show
};

}  // namespace greatx::render
