// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Paths with a diffraction or a scattering in the middle: reflections from the source to a wedge or a patch
// (prefix), reflections from there to the target (suffix). Prefixes come from the source's candidates,
// suffixes from a search at the target; they meet at the wedge or the patch.
#pragma once

#include <cstdint>
#include <vector>

#include "rf/config/path_limits.h"
#include "rf/geometry/candidates.h"
#include "rf/geometry/geometry.h"
#include "rf/geometry/path.h"
#include "rf/paths/radio_model.h"

namespace greatx::rf {

/// A piece of a facet that scatters as a whole.
struct Patch {
  uint32_t facet = 0;
  uint32_t number = 0;  ///< on its facet
  dvec3 center{0.0};    ///< in its body's frame
  double area_m2 = 0.0;
};

/// Cuts every facet whose material scatters into triangles with sides of at most `side_m` (each cut halves
/// the longest side), in the order of its triangles. Throws UserError if there are more than `most`.
std::vector<Patch> scattering_patches(const scene::Scene& scene, const FacetKinds& kinds, double side_m,
                                      size_t most = 10'000'000);

class Midpoints {
 public:
  /// `model` is read by every call and must outlive this. With PathLimits::max_reflections_after above 0
  /// there is a search at every target. `moving_bodies`: facets of bodies other than 0 reflect.
  Midpoints(const RadioModel& model, const PathLimits& limits, bool moving_bodies);

  /// Which sequences lead to which wedges and patches; `tree` is built from the same candidates, which list
  /// wedges if diffraction is on. Patches outside the window of their facet are left out: nothing of the beam
  /// gets there.
  void set_candidates(const CandidateList& candidates, const ImageTree& tree);
  /// The source of `tree` has moved, or bodies have: windows hold no more.
  void move(const ImageTree& tree);
  /// Appends every such path between the source of `tree` (as it was given last) and `target` (carried by
  /// `target_body`), from transmitter to receiver, in no particular order. What the search at the target left
  /// out.
  LeftOut solve(const ImageTree& tree, const dvec3& target, uint32_t target_body,
                std::vector<GeometricPath>& paths) const;

 private:
  /// For every wedge, or facet, the sequences that lead to it: [elements + 1] into `sequences`, ascending.
  struct Arrivals {
    std::vector<uint32_t> offsets, sequences;
    std::span<const uint32_t> of(uint32_t element) const {
      return std::span(sequences).subspan(offsets[element], offsets[element + 1] - offsets[element]);
    }
  };
  /// A sequence that ends at a patch, all the way from its end of the path.
  struct PatchArrival {
    uint32_t first = 0, depth = 0;  ///< reflections, into PatchArrivals::facets and points, outwards
    dvec3 from{0.0};                ///< vertex before the patch
    double length_m = 0.0;          ///< to the patch's centre
  };
  struct PatchArrivals {
    std::vector<uint32_t> offsets;  ///< [patches + 1] into arrivals
    std::vector<PatchArrival> arrivals;
    std::vector<uint32_t> facets;
    std::vector<dvec3> points;
    std::span<const PatchArrival> of(size_t patch) const {
      return std::span(arrivals).subspan(offsets[patch], offsets[patch + 1] - offsets[patch]);
    }
  };
  struct Chain;
  Arrivals arrivals_at_wedges(const CandidateList& candidates) const;
  Arrivals arrivals_at_facets(const CandidateList& candidates, uint32_t most_reflections,
                              std::vector<PlaneWindow>& windows) const;
  PatchArrivals arrivals_at_patches(const Arrivals& at_facets, const std::vector<PlaneWindow>& windows,
                                    const ImageTree& tree) const;
  PatchArrivals straight_to_patches(const dvec3& from) const;
  dvec3 center(const Patch& patch) const;
  void diffract(const Chain& chain, const scene::Wedge& wedge, uint32_t index,
                std::vector<GeometricPath>& paths) const;
  void scatter(const ImageTree& tree, const dvec3& target, size_t patch, const PatchArrivals& suffixes,
               std::vector<GeometricPath>& paths) const;
  void join_at_wedges(const ImageTree& tree, const ImageTree& suffixes, const Arrivals& wedges,
                      std::vector<GeometricPath>& paths) const;

  const RadioModel* model_;
  PathLimits limits_;
  bool moving_bodies_;
  std::vector<Patch> patches_;
  Arrivals at_wedges_, at_facets_;
  PatchArrivals at_patches_;
};

}  // namespace greatx::rf
