// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Finds the surfaces between two points. The GPU traces segments of paths in the tick's command buffer.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "core/vec.h"
#include "gpu/pipeline.h"
#include "gpu/tick_ring.h"
#include "rf/facets/facet_kind.h"
#include "rf/facets/foliage_volumes.h"
#include "rf/paths/exact_crossings.h"
#include "rf/paths/segment.h"
#include "scene/device/gpu_scene.h"
#include "shaders/shared/rf.h"

namespace greatx::rf {

/// Traces segments by these rules:
/// - The facets and bodies that the segment names never count, wherever it crosses them.
/// - A surface does not count if an end lies in its plane as far as fp32 can tell: within
///   shared::visibility_tolerance, which is 0.1 mm plus 2.4e-7 of the largest coordinate (0.17 mm at 300 m,
///   2.5 mm at 10 km from the local origin). Hence a point exactly on a surface is seen from both of its
///   sides, and a point 5 mm in front of a surface is seen only from the front.
/// - A wall counts once, however many of its triangles meet at the crossing. Walls in one plane (neighbours,
///   or a wall that exists twice) also count once, within that tolerance, and so do walls that are passed in
///   their common edge. The wall with the lowest index is listed.
/// - A segment from a point to itself meets nothing.
/// - Texels of alpha masks are solid.
/// - The driver traces in fp32. Where a segment passes an edge within roundings (some tenths of a millimetre
///   at 300 m), the host decides by the same rules in fp64 (rf/paths/exact_crossings.h). There, an end of the
///   segment on a facet does not see through another facet that stands at an angle to it.
///
/// Foliage is a closed volume with its faces outwards. It has its own rules, since nothing jumps where a
/// segment meets a surface of foliage next to an end. Planes through the ends and named facets do not matter,
/// named bodies do, and ends may be inside the foliage or on it. Lengths are fixed-point with a unit of 2^-24
/// of the segment, in addition to the rounding of fp32: about 0.1 mm over 100 m, 10 mm at 10 km from the
/// origin.
class CrossingPass {
 public:
  /// Builds the pipeline (with walls and foliage only if `kinds` has any) and uploads the facets' planes and
  /// kinds, [facets of the scene]. A batch is traced in parts whose buffers hold at most `part_bytes` each,
  /// and not more than a shader of the device can address in one buffer. Answers do not depend on the parts.
  CrossingPass(scene::GpuScene& scene, const FacetKinds& kinds, uint64_t part_bytes = uint64_t{128} << 20);

  /// Describes rows that are traced together.
  struct Part {
    uint32_t first = 0, count = 0;
    /// Index of the part with the leaders of these segments; its own index if they have no leaders.
    uint32_t leaders = 0;
    gpu::Slice segments = {}, results = {};
  };
  /// Describes where the answers of one batch will be; valid until its slot is begun again.
  struct Pending {
    std::vector<Part> parts = {};       ///< ordered by `first`
    uint32_t row_words = 0;             ///< words of each row
    std::vector<uint32_t> row_of = {};  ///< [segments]
  };

  /// Records a batch for the scene as scene.record_update left it in this tick. The answer of a segment
  /// depends only on the segment (and on its leader). An empty batch records nothing. Throws UserError if
  /// there are more than 2^32 - 2 segments.
  [[nodiscard]] Pending record(gpu::TickSlot& slot, std::span<const Segment> segments);
  /// Returns the answers in the order of the segments, after the slot's submission is done. `segments` must
  /// be those that were recorded. `world` has the bodies in the poses of that tick. `settled` receives the
  /// number of segments that the host has decided.
  std::vector<Crossing> collect(const Pending& pending, std::span<const Segment> segments,
                                const FacetWorld& world, uint64_t* settled = nullptr) const;

 private:
  struct Rows;
  std::vector<Part> parts_of(const Rows& rows, std::span<const Segment> segments, uint32_t row_words) const;
  void upload(const Rows& rows, std::span<const Segment> segments, const std::vector<Part>& parts,
              const Part& part) const;
  uint64_t settle(std::span<const Segment> segments, const FacetWorld& world,
                  std::vector<Crossing>& crossings) const;
  void dispatch(gpu::Cmd& cmd, const Part& part, const Part& leaders, uint32_t row_words);

  scene::GpuScene* scene_;
  FoliageVolumes static_foliage_;
  ExactCrossings exact_;
  gpu::ComputePipeline pipeline_;
  gpu::Buffer planes_, foliage_;
  uint32_t foliage_boxes_ = 0;
  bool walls_ = false, planes_by_address_ = false;
  uint64_t part_bytes_;
};

}  // namespace greatx::rf
