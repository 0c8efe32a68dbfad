// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Defines the sun's shadow maps. One map holds everything that never moves and is rendered once. One atlas
// has a tile for each moving body and is rendered every tick. Depth is reversed: nearer the sun is larger,
// and nothing is 0.
#pragma once

#include <span>
#include <vector>

#include "core/vec.h"
#include "gpu/cmd.h"
#include "gpu/tick_ring.h"
#include "scene/device/gpu_scene.h"
#include "shaders/shared/camera.h"

namespace greatx::render {

/// Holds right-handed axes in the local frame, with z to the sun.
struct SunFrame {
  dvec3 x{1, 0, 0}, y{0, 1, 0}, z{0, 0, 1};
  static SunFrame of(const dvec3& to_sun);
  dvec3 from_local(const dvec3& p) const { return {glm::dot(x, p), glm::dot(y, p), glm::dot(z, p)}; }
};

struct ShadowOptions {
  bool static_casters = false, moving_casters = false, alpha_mask = false;
  uint32_t static_texels = 4096, moving_tile_texels = 512;
};

class ShadowMaps {
 public:
  ShadowMaps() = default;
  /// Renders the static map in a set-up submission. Parts that `options` leave out are never built.
  ShadowMaps(const scene::GpuScene& scene, const SunFrame& frame, const ShadowOptions& options);

  /// Fills in the map's part of the lighting block.
  void describe(shared::GpuLighting& block) const;
  /// Records the tiles of this tick's poses, and their content. `block` is the lighting block.
  void record(gpu::TickSlot& slot, std::span<const Pose> body_poses, const gpu::Slice& block);
  std::vector<gpu::Descriptor> descriptors() const;
  const SunFrame& frame() const { return frame_; }
  /// The number of bodies that cast moving shadows.
  size_t tile_count() const { return casters_.size(); }

 private:
  struct Caster {
    uint32_t body = 0;
    dvec3 center{0.0};  ///< centre of the bounding sphere, body frame
    double radius = 0.0;
    std::vector<uint32_t> opaque, masked;  ///< primitives
  };
  void build_static(bool alpha_mask);
  void build_moving(bool alpha_mask);
  void draw(gpu::Cmd& cmd, std::span<const uint32_t> primitives) const;
  gpu::GraphicsPipeline pipeline(bool moving, bool masked) const;

  const scene::GpuScene* scene_ = nullptr;
  ShadowOptions options_;
  SunFrame frame_;
  gpu::Image static_map_, moving_map_;  ///< 1 x 1 where not wanted
  gpu::Sampler sampler_;
  gpu::GraphicsPipeline moving_opaque_, moving_masked_;
  /// Bounds of the static casters in the sun's frame, with margins.
  dvec3 static_min_{0.0}, static_max_{1.0};
  std::vector<Caster> casters_;
  uint32_t tiles_across_ = 0;
  gpu::Slice tiles_;
  gpu::Buffer no_tiles_;
};

}  // namespace greatx::render
