// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Lets a camera see through panes of glass (renderer/surface/pane_color.h). The solid surfaces are drawn
// first. Then the panes before them are drawn twice: once so that each sample holds the product of the light
// that all of them let through, whatever their number and order, and once so that it holds the nearest. The
// nearest pane is shaded with its mirror image. The mirror images of the panes behind it are left out
// (docs/global_light.md has the error). Panes count as solid beyond the distance at which their light has
// faded (shared::pane_shows).
#pragma once

#include <span>
#include <string>

#include "gpu/cmd.h"
#include "renderer/camera/camera.h"
#include "renderer/camera/camera_view.h"
#include "renderer/camera/draw_list.h"

namespace greatx::render {

/// Returns the distance from the eye, m, beyond which panes count as solid.
double pane_reach(const CameraView& view);

class PanePass {
 public:
  /// `shading` is that of what is solid. `width` and `height` are those of the visibility pass.
  PanePass(const SceneLighting& lighting, const CameraDesc& desc, const gpu::ComputeDesc& shading,
           uint32_t width, uint32_t height);

  /// Draws pieces of one primitive each, numbered by `order`, before what `depth` holds, and prepares the
  /// images for shading.
  void draw(gpu::Cmd& cmd, const CameraView& view, std::span<const DrawPiece> panes,
            std::span<const uint32_t> order, gpu::Image& depth);
  /// The pipeline that shades the nearest panes. Beside its own descriptors it takes those of what is solid,
  /// but for the visibility and the picture.
  const gpu::ComputePipeline& shade() const { return shade_; }
  std::vector<gpu::Descriptor> descriptors(const gpu::Sampler& texels) const;

 private:
  const SceneLighting* lighting_;
  bool multisampled_;
  std::string scope_;
  gpu::GraphicsPipeline passes_pipeline_, nearest_pipeline_;
  gpu::ComputePipeline shade_;
  gpu::Image passes_;   ///< what all panes of a sample let through
  gpu::Image nearest_;  ///< triangle + 1
};

}  // namespace greatx::render
