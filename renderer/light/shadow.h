// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Defines the sun's shadow maps. One map holds everything that never moves and is rendered once. One atlas
// has a tile for each moving body (renderer/light/moving_shadow.h). Depth is reversed: nearer the sun is
// larger, and nothing is 0.
#pragma once

#include <span>
#include <vector>

#include "core/vec.h"
#include "gpu/cmd.h"
#include "gpu/tick_ring.h"
#include "renderer/light/moving_shadow.h"
#include "renderer/light/sun_frame.h"
#include "scene/device/gpu_scene.h"
#include "shaders/shared/camera.h"

namespace greatx::render {

struct ShadowOptions {
  bool static_casters = false, moving_casters = false, alpha_mask = false;
  uint32_t static_texels = 4096, moving_tile_texels = 512;
  std::vector<bool> closed;  ///< by body (renderer/surface/closed_bodies.h)
  /// The records of materials. Panes (renderer/surface/pane_color.h) let light through by them; null: they
  /// are solid.
  const gpu::Buffer* panes = nullptr;
};

class ShadowMaps {
 public:
  ShadowMaps() = default;
  /// Renders the static map in a set-up submission. Parts that `options` leave out are never built.
  ShadowMaps(const scene::GpuScene& scene, const SunFrame& frame, const ShadowOptions& options);

  /// Fills in the maps' part of the lighting block.
  void describe(shared::GpuLighting& block) const;
  std::vector<gpu::Descriptor> descriptors() const;
  const SunFrame& frame() const { return frame_; }
  const scene::GpuScene& scene() const { return *scene_; }
  bool alpha_mask() const { return options_.alpha_mask; }
  /// The records of materials, if panes let light through.
  const gpu::Buffer* panes() const { return options_.panes; }
  /// The edge of a texel of the static map, m, and the depths in it: z depth_scale() + depth_offset().
  double static_texel_m() const { return (static_max_.x - static_min_.x) / static_map_.desc().width; }
  double depth_scale() const { return 1.0 / (static_max_.z - static_min_.z); }
  double depth_offset() const { return -static_min_.z * depth_scale(); }
  const gpu::Image& static_map() const { return static_map_; }
  const gpu::Sampler& sampler() const { return sampler_; }
  MovingShadows& moving() { return moving_; }
  const MovingShadows& moving() const { return moving_; }

 private:
  void build_static(bool alpha_mask);

  const scene::GpuScene* scene_ = nullptr;
  ShadowOptions options_;
  SunFrame frame_;
  gpu::Image static_map_;  ///< 1 x 1 where not wanted
  gpu::Sampler sampler_;
  /// Bounds of the static casters in the sun's frame, with margins.
  dvec3 static_min_{0.0}, static_max_{1.0};
  MovingShadows moving_;
};

}  // namespace greatx::render
