// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Defines the shadows of moving bodies: an atlas with a tile for each body that is no part of another. A tile
// depends on how its body and the body's parts are turned, not on where the body is. It is drawn anew if they
// turn, and if some picture may show its shadow.
#pragma once

#include <functional>
#include <span>
#include <vector>

#include "core/vec.h"
#include "gpu/cmd.h"
#include "gpu/tick_ring.h"
#include "renderer/light/sun_frame.h"
#include "scene/device/gpu_scene.h"
#include "shaders/shared/camera.h"

namespace greatx::render {

struct MovingShadowOptions {
  bool casters = false, alpha_mask = false;
  uint32_t tile_texels = 128;          ///< edge of a tile, at most
  std::vector<bool> closed;            ///< by body (renderer/surface/closed_bodies.h)
  const gpu::Buffer* panes = nullptr;  ///< as ShadowOptions::panes
};

class MovingShadows {
 public:
  /// Says whether a ball that moves from one point to another, in local coordinates, stays outside a picture.
  using Outside = std::function<bool(const dvec3& from, const dvec3& to, double radius)>;

  MovingShadows() = default;
  MovingShadows(const scene::GpuScene& scene, const SunFrame& frame, const MovingShadowOptions& options);

  /// Records the tiles of these poses into the slot, without their content.
  void record(gpu::TickSlot& slot, std::span<const Pose> body_poses);
  /// Records the content of those tiles that have turned since they were drawn, if their shadows may fall
  /// into a picture. The slot is that of `record`.
  void draw(gpu::TickSlot& slot, const Outside& outside);

  /// The number of bodies that cast moving shadows.
  size_t tile_count() const { return casters_.size(); }
  /// The number of tiles whose content has been recorded so far.
  uint64_t drawn_tiles() const { return drawn_tiles_; }
  uint32_t map_size() const { return map_.desc().width; }
  const gpu::Image& map() const { return map_; }
  const gpu::Slice& tiles() const { return tiles_; }

 private:
  struct Range {
    uint32_t first_index = 0, index_count = 0, primitive = 0;
  };
  struct Part {
    uint32_t body = 0;
    bool round = false;  ///< it looks the same however it has turned on its joint
    std::vector<Range> opaque, masked, closed, panes;  ///< `closed` faces away from the sun are left out
  };
  struct Caster {
    uint32_t body = 0, first_part = 0;
    dvec3 center{0.0};  ///< centre of the bounding sphere, body frame
    double radius = 0.0;
    std::vector<Part> parts;
  };
  void collect(const MovingShadowOptions& options);
  Part part_of(uint32_t body, const MovingShadowOptions& options, const std::vector<bool>& is_pane) const;
  shared::GpuShadowTile tile_of(uint32_t caster, std::span<const Pose> body_poses) const;
  shared::GpuShadowPart rows_of(const Caster& caster, const Part& part, const shared::GpuShadowTile& tile,
                                std::span<const Pose> body_poses) const;
  std::vector<uint32_t> stale(const Outside& outside) const;
  std::span<const shared::GpuShadowPart> rows(const std::vector<shared::GpuShadowPart>& all,
                                              const Caster& caster) const {
    return std::span(all).subspan(caster.first_part, caster.parts.size());
  }

  const scene::GpuScene* scene_ = nullptr;
  SunFrame frame_;
  gpu::Image map_;  ///< 1 x 1 without casters
  gpu::GraphicsPipeline opaque_, masked_, closed_, pane_pipeline_;
  const gpu::Buffer* panes_ = nullptr;
  std::vector<Caster> casters_;
  uint32_t tiles_across_ = 0, part_count_ = 0;
  uint64_t drawn_tiles_ = 0;
  // The poses recorded last:
  std::vector<dvec3> centers_;  ///< by caster, local coordinates
  double lowest_ = 0.0;         ///< height below which no shadow falls on anything
  std::vector<shared::GpuShadowPart> wanted_;
  gpu::Slice tiles_;
  gpu::Buffer no_tiles_;
  // What the atlas holds; parts of tiles with unknown content are NaN.
  std::vector<shared::GpuShadowPart> drawn_;
};

}  // namespace greatx::render
