// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Finds candidates by shooting and bouncing rays. Rays leave one point in a Fibonacci lattice and reflect
// specularly off both sides of every facet that they meet. Each prefix of the sequence of facets that reflect
// a ray is a candidate. At a wall (FacetKind::wall) a ray goes both ways, reflected and straight on, and no
// choice is random. Rays pass through foliage.
//
// The search may miss a sequence whose beam, seen from the source, is narrower than the spacing of the rays,
// sqrt(4 pi / rays) rad. The exact geometry (rf/geometry/geometry.h) turns candidates into paths or rejects
// them.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "core/vec.h"
#include "gpu/pipeline.h"
#include "gpu/tick_ring.h"
#include "rf/facets/facet_kind.h"
#include "rf/geometry/candidates.h"
#include "scene/device/gpu_scene.h"
#include "shaders/shared/rf.h"

namespace greatx::rf {

struct CandidateSearchOptions {
  uint32_t rays = 1u << 18;
  uint32_t max_depth = 3;  ///< facets that a ray meets, reflected or passed; 1 or more
  /// Walls that a ray passes on its way, as far as max_depth allows. A ray then has as many ways as there are
  /// orders of reflections and transmissions that end with a reflection, ways_per_ray(). With 0, walls are
  /// opaque.
  uint32_t max_transmissions = 0;
  bool moving_bodies = true;     ///< false: only the static world takes part
  uint64_t capacity = 1u << 22;  ///< largest number of candidates kept; further ones are counted
  uint32_t max_ways = 64;        ///< largest number of ways kept per ray; further ones are counted
  /// Bounds the device memory of the keys, rays * ways * max_depth * 4 bytes, by splitting the search into
  /// parts. record() needs as much host memory as all parts together, search() as much as one part.
  uint64_t part_bytes = 64u << 20;
};

struct CandidateSearchResult {
  CandidateList list;     ///< canonical order, no duplicates, without the line of sight
  uint64_t found = 0;     ///< number of distinct sequences met
  uint64_t left_out = 0;  ///< ways of rays beyond max_ways, whose sequences other rays may have met or not
  /// Returns the number of results left out: sequences beyond the capacity, from the end of the canonical
  /// order (the deepest first), and ways beyond max_ways. A number above zero must be reported.
  uint64_t overflow() const { return found - list.size() + left_out; }
};

/// Returns the number of ways of a ray through walls alone: the sum of (max_depth - 1 choose t) for t <=
/// max_transmissions. It saturates at 2^32 - 1.
uint32_t ways_per_ray(uint32_t max_depth, uint32_t max_transmissions);

/// Returns the unit vectors of a Fibonacci lattice on the sphere: z_i = 1 - (2 i + 1) / n, azimuth i / golden
/// ratio turns (R. Swinbank, R. J. Purser, "Fibonacci grids", QJRMS 132, 2006). They are in the order of a
/// Hilbert curve, so that rays that run side by side have similar directions. The result depends on `count`
/// alone.
std::vector<vec3> fibonacci_lattice(uint32_t count);

/// Returns every prefix of every key, once, in canonical order. `keys` is [rays * max_depth]: facets, then
/// shared::rf_none.
CandidateSearchResult candidates_from_keys(std::span<const uint32_t> keys, uint32_t max_depth,
                                           uint64_t capacity);

class CandidateSearch {
 public:
  /// Builds the pipeline and uploads the lattice. `kinds` is [facets of the scene], or empty if all facets
  /// are opaque. Throws UserError if the device cannot hold so many rays.
  CandidateSearch(scene::GpuScene& scene, const CandidateSearchOptions& options,
                  const FacetKinds& kinds = {});

  /// Holds the place of a recorded search's results; valid until its slot is begun again.
  struct Pending {
    std::vector<gpu::Slice> keys;  ///< one per part
  };

  /// Records a search from `source` (local coordinates) in the scene as scene.record_update left it in this
  /// tick.
  [[nodiscard]] Pending record(gpu::TickSlot& slot, const dvec3& source);
  /// Returns the candidates, after the slot's submission is done. They do not depend on the device's order of
  /// work.
  CandidateSearchResult collect(const Pending& pending) const;

  /// Searches outside the ticks in a set-up submission of its own, and waits for it. It calls
  /// GpuScene::record_update with `body_poses`: record an update again before the next pass of a tick.
  CandidateSearchResult search(std::span<const Pose> body_poses, const dvec3& source);

  const CandidateSearchOptions& options() const { return options_; }

 private:
  /// Describes rays that are searched together.
  struct Part {
    uint32_t first = 0, rays = 0;
  };
  struct Gathered {
    std::vector<uint32_t> keys;  ///< [rows * max_depth]
    uint64_t left_out = 0;
  };
  std::vector<Part> parts() const;
  size_t key_words(uint32_t rays) const;  ///< words of the keys of `rays`
  size_t words(uint32_t rays) const;      ///< words of the keys and of the counts behind them
  void record_part(gpu::Cmd& cmd, const dvec3& source, const Part& part, const gpu::Slice& target);
  void add_part(const Part& part, const gpu::Slice& slice, Gathered& gathered) const;
  CandidateSearchResult result_of(const Gathered& gathered) const;
  std::vector<uint32_t> kinds_of(const FacetKinds& kinds);

  scene::GpuScene* scene_;
  CandidateSearchOptions options_;
  uint32_t slots_ = 1;            ///< keys per ray
  bool counts_left_out_ = false;  ///< rays may have more ways than slots
  bool foliage_ = false, walls_ = false;
  uint32_t part_rays_ = 0;
  gpu::ComputePipeline pipeline_;
  gpu::Buffer directions_, kinds_, keys_;
};

}  // namespace greatx::rf
