// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Paths with a diffraction or a scattering in the middle: reflections from the source to a wedge or a patch (prefix),
// reflections from there to the target (suffix). Prefixes come from the source's candidates, suffixes from a search at
// the target; they meet at the wedge or the patch.
#pragma once

#include <cstdint>
#include <vector>

#include "rf/candidates.h"
#include "rf/geometry.h"
#include "rf/path.h"
#include "rf/radio_model.h"

namespace greatx::rf {

/// A piece of a facet that scatters as a whole.
struct Patch {
  uint32_t facet = 0;
  uint32_t number = 0;  ///< on its facet
  dvec3 center{0.0};    ///< in its body's frame
  double area_m2 = 0.0;
};

/// Cuts every facet whose material scatters into triangles with sides of at most `side_m` (each cut halves the longest
/// side), in the order of its triangles. Throws UserError if there are more than `most`.
std::vector<Patch> scattering_patches(const scene::Scene& scene, const FacetKinds& kinds, double side_m,
                                      size_t most = 10'000'000);

struct MidpointOptions {
  uint32_t max_depth = 3;              ///< interactions on a path
  uint32_t max_transmissions = 0;      ///< of them walls passed
  uint32_t max_reflections_after = 0;  ///< on the target's side; more than 0: a search at every target
  double patch_m = 10.0;
  bool moving_bodies = false;  ///< facets of bodies other than 0 reflect
};

class Midpoints {
 public:
  /// `model` is read by every call and must outlive this.
  Midpoints(const RadioModel& model, const MidpointOptions& options);

  /// Which sequences reach which wedges and facets; `candidates` from the source, with wedges if diffraction is on.
  void set_candidates(const CandidateList& candidates);
  /// Appends every such path between the source of `tree` (built from the same candidates) and `target` (carried by `target_body`), from transmitter
  /// to receiver.
  void solve(const ImageTree& tree, const dvec3& target, uint32_t target_body,
             std::vector<GeometricPath>& paths) const;

 private:
  /// For every wedge, or facet, the sequences that lead to it: [elements + 1] into `sequences`, ascending.
  struct Arrivals {
    std::vector<uint32_t> offsets, sequences;
    std::span<const uint32_t> of(uint32_t element) const {
      return std::span(sequences).subspan(offsets[element], offsets[element + 1] - offsets[element]);
    }
  };
  struct Chain;
  Arrivals arrivals_at_wedges(const CandidateList& candidates) const;
  Arrivals arrivals_at_facets(const CandidateList& candidates) const;
  void diffract(const Chain& chain, uint32_t wedge, std::vector<GeometricPath>& paths) const;
  void scatter(const Chain& chain, const Patch& patch, std::vector<GeometricPath>& paths) const;
  void join(const ImageTree& tree, const ImageTree& suffixes, const Arrivals& wedges, const Arrivals& facets,
            std::vector<GeometricPath>& paths) const;

  const RadioModel* model_;
  MidpointOptions options_;
  std::vector<Patch> patches_;
  std::vector<uint32_t> patch_offsets_;  ///< [facets + 1] into patches_
  Arrivals at_wedges_, at_facets_;
};

}  // namespace greatx::rf
