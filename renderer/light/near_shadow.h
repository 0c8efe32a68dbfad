// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Defines finer maps of the static shadows around a camera: cascades. The map over the whole scene
// (renderer/light/shadow.h) stays and serves what lies farther away.
//
// A cascade is a square of near_pages x near_pages pages of a lattice that is fixed in the sun's frame. A
// page holds the same depths wherever the camera stands, and lies at its place on the lattice modulo
// near_pages. When the camera moves, only pages that come into the square are drawn. Shadows therefore do
// not crawl: within a cascade they do not depend on the camera at all. Every camera has cascades of its own.
#pragma once

#include <array>
#include <vector>

#include "core/vec.h"
#include "gpu/cmd.h"
#include "gpu/tick_ring.h"
#include "renderer/light/shadow.h"
#include "scene/device/gpu_scene.h"
#include "shaders/shared/camera.h"

namespace greatx::render {

inline constexpr uint32_t near_pages = 8;          ///< along an edge of a cascade
inline constexpr uint32_t near_page_texels = 256;  ///< along an edge of a page
inline constexpr uint32_t near_map_texels = near_pages * near_page_texels;
/// The texel of the finest cascade, m, unless the map over the whole scene is less than twice as coarse.
inline constexpr double near_texel_m = 0.0625;

/// Returns the texels of a scene's cascades, finest first, m: powers of two. There are two of them if the map
/// over the whole scene, whose texel is given, is at least four times as coarse as the finest.
std::vector<double> cascade_texels(double static_texel_m);

class NearShadows {
 public:
  /// `base` and its scene outlive this.
  explicit NearShadows(const ShadowMaps& base);

  /// Records the pages that a view from `eye` (local coordinates) lacks.
  void record(gpu::TickSlot& slot, const dvec3& eye);
  /// The descriptors of the maps as the last record() left them.
  std::vector<gpu::Descriptor> descriptors() const;
  /// Returns descriptors that stand for them in shaders without cascades, which do not read them.
  static std::vector<gpu::Descriptor> no_descriptors(const ShadowMaps& base);
  static std::vector<gpu::Binding> bindings();

  uint32_t cascades() const { return static_cast<uint32_t>(levels_.size()); }
  double texel_m(uint32_t cascade) const { return levels_[cascade].texel_m; }
  /// Half of the edge of the square that a cascade serves, m, in the sun's x and y around center_of(eye).
  double reach_m(uint32_t cascade) const;
  /// The place in the sun's x and y around which the cascades of an eye lie: that of the ground below it.
  dvec2 center_of(const dvec3& eye) const;
  /// The number of pages drawn so far.
  uint64_t drawn_pages() const { return drawn_pages_; }

 private:
  /// Holds up to block_triangles triangles of a primitive that follow one another.
  struct Block {
    uint32_t primitive = 0, first_index = 0, index_count = 0;
    dvec2 least{0.0}, most{0.0};  ///< bounds in the sun's x and y
  };
  struct Page {
    int64_t x = 0, y = 0;
    bool known = false;
  };
  struct Level {
    double texel_m = 1.0;
    gpu::Image map;
    std::array<Page, size_t{near_pages} * near_pages> pages;
  };
  void find_casters();
  void find_ground();
  double ground_below(const dvec2& at) const;
  static std::vector<uint32_t> claim_missing(Level& level, const dvec2& center);
  void draw(gpu::Cmd& cmd, Level& level, const std::vector<uint32_t>& pages);
  void draw_blocks(gpu::Cmd& cmd, const Level& level, const Page& page,
                   const std::vector<Block>& blocks) const;

  const ShadowMaps* base_;
  const scene::GpuScene* scene_;
  std::vector<Block> opaque_, masked_, panes_;
  gpu::GraphicsPipeline opaque_pipeline_, masked_pipeline_, pane_pipeline_;
  gpu::Sampler sampler_;
  std::vector<Level> levels_;
  /// Lowest heights of the static world over cells of ground_cell_m, local x and y.
  uint32_t columns_ = 1, rows_ = 1;
  std::vector<double> ground_;
  gpu::Slice block_;  ///< GpuNearShadows of the last record()
  uint64_t drawn_pages_ = 0;
};

}  // namespace greatx::render
