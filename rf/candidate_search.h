// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Candidates by shooting and bouncing: rays leave one point in a Fibonacci lattice and reflect specularly off
// both sides of every facet they meet; each prefix of the sequence of facets that a ray meets is a candidate.
//
// What it may miss: a sequence whose beam, seen from the source, is narrower than the spacing of the rays,
// sqrt(4 pi / rays) rad. The exact geometry (rf/geometry.h) turns candidates into paths or throws them out.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "core/vec.h"
#include "gpu/pipeline.h"
#include "gpu/tick_ring.h"
#include "rf/candidates.h"
#include "scene/gpu_scene.h"
#include "shaders/shared/rf.h"

namespace greatx::rf {

struct CandidateSearchOptions {
  uint32_t rays = 1u << 18;
  uint32_t max_depth =
      3;  ///< reflections per candidate, 1 or more; rays * max_depth must fit a storage buffer
  bool moving_bodies = true;     ///< false: the static world alone, as if nothing that moves were there
  uint64_t capacity = 1u << 22;  ///< at most this many candidates are kept; the rest is counted
};

struct CandidateSearchResult {
  CandidateList list;  ///< canonical order, no duplicates; the line of sight is not in it
  uint64_t found = 0;  ///< distinct sequences met
  /// Sequences beyond the capacity, left out from the end of the canonical order (the deepest first). Not
  /// zero: say so.
  uint64_t overflow() const { return found - list.size(); }
};

/// Unit vectors of a Fibonacci lattice on the sphere: z_i = 1 - (2 i + 1) / n, azimuth i / golden ratio turns
/// (R. Swinbank, R. J. Purser, "Fibonacci grids", QJRMS 132, 2006), in the order of a Hilbert curve, so that
/// rays that run side by side look the same way. A function of `count` alone.
std::vector<vec3> fibonacci_lattice(uint32_t count);

/// Every prefix of every key, once, in canonical order. `keys` [rays * max_depth]: facets, then
/// shared::rf_none.
CandidateSearchResult candidates_from_keys(std::span<const uint32_t> keys, uint32_t max_depth,
                                           uint64_t capacity);

class CandidateSearch {
 public:
  /// Builds the pipeline and uploads the lattice. Throws UserError if the device cannot hold so many rays.
  CandidateSearch(scene::GpuScene& scene, const CandidateSearchOptions& options);

  /// Where a recorded search will be; valid until its slot is begun again.
  struct Pending {
    gpu::Slice keys;
  };

  /// Records a search from `source` (local coordinates) among the scene as scene.record_update left it in
  /// this tick.
  [[nodiscard]] Pending record(gpu::TickSlot& slot, const dvec3& source);
  /// The candidates, after the slot's submission is done. The same whatever the device's order of work.
  CandidateSearchResult collect(const Pending& pending) const;

  /// The same outside the ticks, in a set-up submission of its own (waits for it). `body_poses` as for
  /// GpuScene::record_update, which is called: record it again before the next pass of a tick.
  CandidateSearchResult search(std::span<const Pose> body_poses, const dvec3& source);

  const CandidateSearchOptions& options() const { return options_; }

 private:
  scene::GpuScene* scene_;
  CandidateSearchOptions options_;
  gpu::ComputePipeline pipeline_;
  gpu::Buffer directions_, keys_;
};

}  // namespace greatx::rf
