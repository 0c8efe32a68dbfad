// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// What stands between two points? Segments of paths, traced on the GPU in the tick's command buffer.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "core/vec.h"
#include "gpu/pipeline.h"
#include "gpu/tick_ring.h"
#include "rf/facets/facet_kind.h"
#include "rf/facets/foliage_volumes.h"
#include "scene/device/gpu_scene.h"
#include "shaders/shared/rf.h"

namespace greatx::rf {

/// A stretch of a path, with what its ends belong to and therefore does not stand in its way.
struct Segment {
  dvec3 a{0.0}, b{0.0};                ///< local coordinates, metres
  uint32_t facet_a = shared::rf_none;  ///< a facet that the path touches in `a`; rf_none: none
  uint32_t facet_b = shared::rf_none;
  uint32_t body_a =
      shared::rf_none;  ///< body that carries the node in `a` and is not to hide it; rf_none: none
  uint32_t body_b = shared::rf_none;
  uint32_t other_a = shared::rf_none;  ///< the second face of the wedge in `a`; rf_none: none
  uint32_t other_b = shared::rf_none;
  uint32_t walls = 0;  ///< FacetKind::wall that it may pass, at most shared::crossings_max
  /// An earlier segment of the batch with the same ends, that may pass as many walls at least: its answer,
  /// with all its walls, is this one's. rf_none: none.
  uint32_t same_as = shared::rf_none;
  /// A segment of the batch that has to be clear: if it is blocked, this one counts as blocked without being
  /// looked at. That one hangs on none itself. rf_none: none.
  uint32_t only_if = shared::rf_none;
};

/// What a segment meets.
struct Crossing {
  bool blocked = false;  ///< by an opaque facet, or by more walls than allowed; then the rest means nothing
  std::vector<uint32_t> walls;  ///< facets passed, ascending by index, each once
  double foliage_m = 0.0;  ///< of its length inside foliage, ends inside included; overlapping volumes add up
  /// The foliage met on the segment's line is no closed volume with its faces outwards: foliage_m is what can
  /// be told.
  bool foliage_open = false;
};

/// What counts as crossed:
/// - the facets and bodies named in the segment never count, wherever it crosses them;
/// - nor does a surface whose plane an end lies in as far as fp32 can tell: within
///   shared::visibility_tolerance, 0.1 mm plus 2.4e-7 of the largest coordinate (0.17 mm at 300 m, 2.5 mm at
/// 10 km from
///   the local origin). So a point exactly on a surface is seen from both of its sides, and a point 5 mm in
/// front of one
///   is seen from the front alone;
/// - a wall counts once, however many of its triangles meet where it is passed. So do walls in one plane
///   (neighbours, a
///   wall that is there twice), within that tolerance, and walls that are passed in their common edge: the
/// one of the
///   lowest index is listed;
/// - a segment from a point to itself meets nothing;
/// - texels of alpha masks are solid.
///
/// Foliage is a closed volume with its faces outwards. Its rules are its own, since nothing jumps where a
/// surface is met next to an end: neither ends in its planes nor named facets matter (named bodies do), and
/// ends may be inside or on it. Lengths are fixed-point, 2^-24 of the segment, on top of fp32: some 0.1 mm
/// over 100 m, 10 mm at 10 km from the origin.
class CrossingPass {
 public:
  /// Builds the pipeline (walls and foliage are compiled in only if `kinds` has any) and uploads the facets'
  /// planes and kinds, [facets of the scene]. A batch is traced in parts whose buffers hold at most
  /// `part_bytes`, and not more than the device lets a shader see of one: answers do not depend on it.
  CrossingPass(scene::GpuScene& scene, const FacetKinds& kinds, uint64_t part_bytes = uint64_t{128} << 20);

  /// Rows that are traced at once.
  struct Part {
    uint32_t first = 0, count = 0;
    uint32_t leaders =
        0;  ///< index of the part that has the segments these hang on; its own: they hang on none
    gpu::Slice segments = {}, results = {};
  };
  /// Where the answers of one batch will be; valid until its slot is begun again.
  struct Pending {
    std::vector<Part> parts = {};       ///< by `first`
    uint32_t row_words = 0;             ///< of each row
    std::vector<uint32_t> row_of = {};  ///< [segments]
  };

  /// Records a batch among the scene as scene.record_update left it in this tick. Each segment's answer
  /// depends on it alone (and on the segment that it hangs on). An empty batch records nothing. Throws
  /// UserError if there are more than 2^32 - 2.
  [[nodiscard]] Pending record(gpu::TickSlot& slot, std::span<const Segment> segments);
  /// In the order of the segments; after the slot's submission is done. `segments`: those that were recorded.
  std::vector<Crossing> collect(const Pending& pending, std::span<const Segment> segments) const;

 private:
  struct Rows;
  std::vector<Part> parts_of(const Rows& rows, std::span<const Segment> segments, uint32_t row_words) const;
  void upload(const Rows& rows, std::span<const Segment> segments, const std::vector<Part>& parts,
              const Part& part) const;
  void dispatch(gpu::Cmd& cmd, const Part& part, const Part& leaders, uint32_t row_words);

  scene::GpuScene* scene_;
  FoliageVolumes static_foliage_;
  gpu::ComputePipeline pipeline_;
  gpu::Buffer planes_, foliage_;
  uint32_t foliage_boxes_ = 0;
  bool walls_ = false;
  uint64_t part_bytes_;
};

}  // namespace greatx::rf
