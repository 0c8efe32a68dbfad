// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Candidates with a guarantee: the tree of image sources, each with the beam through what of the facet it was
// mirrored at is lit. Which facets a beam meets, and where, is worked out with polygons (beam_cells.h): a
// facet is dropped only where it lies outside of the beam, or wholly behind others. So the tree holds every
// sequence that has a path to any receiver whatever that keeps clear of edges by half a millimetre; what it
// holds beyond these costs time, never truth.
//
// Why beams and not rays that split: rays know only the directions they took. A beam is the whole set of
// directions, so the answer does not depend on any spacing, and its prunings (side of the mirror, overlap of
// pyramids, hidden polygons) are inequalities in fp64 with room for their roundings.
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <string>

#include "core/vec.h"
#include "rf/facets/facet_kind.h"
#include "rf/facets/facet_world.h"
#include "rf/geometry/candidates.h"
#include "rf/search/beam_scene.h"
#include "scene/description/wedges.h"

namespace greatx::rf {

struct BeamSearchOptions {
  uint32_t max_depth = 3;  ///< reflections + walls passed
  uint32_t max_transmissions =
      0;  ///< walls passed, on the whole path (FacetKind::wall); not more than max_depth
  uint64_t capacity = 1u << 22;  ///< sequences kept; what is beyond is counted
  uint32_t threads = 0;          ///< 0: as many as the machine has. The result does not depend on it
  /// Facets of bodies other than 0 where they stand now; false: they neither reflect nor hide, as they may
  /// move away.
  bool moving_bodies = false;
  /// A body whose facets do not hide what its own antenna sees: the one that carries the source; 0: none.
  uint32_t source_body = 0;
  /// Paths that stay this far clear, in metres, of edges that they have no business with are found for
  /// certain: what stands before a facet may be taken for wider by as much. 0: nothing is taken for hidden
  /// that is not, at the price of twice as many sequences, most of which live in the seams between facets
  /// that meet.
  double clearance_m = 5e-4;
  /// Sequences of more facets are not looked for, those that could go on are found as if they were: less than
  /// max_depth for who takes the last steps another way (MovingSearch).
  uint32_t stop_depth = ~0u;
};

/// The beam of a sequence that can go on: what leaves its last facet within this rectangle of the facet's
/// plane, away from the image.
struct SequenceBeam {
  static constexpr uint32_t none = ~0u;
  dvec3 image{0.0};                ///< the source, mirrored at all facets
  dvec3 center{0.0};               ///< of the rectangle, local coordinates
  dvec3 half_a{0.0}, half_b{0.0};  ///< from there to the middles of its sides
  uint32_t walls = none;           ///< at least so many have been passed; none: nothing can follow
};

struct BeamSearchResult {
  CandidateList
      list;  ///< canonical order, no duplicates, with windows; [0] is the empty sequence (line of sight)
  /// Sequences found, the empty one included. If there are more than `capacity`, the list ends with the last
  /// one that fits, and those of the depths after the one in which that happened have not been looked for:
  /// then this is the least number that there can be.
  uint64_t found = 0;
  uint64_t cells = 0;  ///< cells of beams looked at: what the search cost
  /// Of the sequences [0, beams.size()) of the list, all that have fewer than max_depth facets. That of the
  /// empty one is everything: its rectangle says nothing.
  std::vector<SequenceBeam> beams;
  uint64_t overflow() const { return found - list.size(); }
  /// Up to so many facets the list has all sequences for certain; ~0u: nothing was left out.
  uint32_t complete_depth() const;
};

class BeamSearch {
 public:
  /// `wedges` empty: none are looked for. All arguments are read by search() and must outlive it.
  BeamSearch(const FacetWorld& world, const FacetKinds& kinds, std::span<const scene::Wedge> wedges,
             const BeamSearchOptions& options);
  /// Every sequence of facets whose beam from `source` (local coordinates) is not proven dark. Not to be
  /// called from two threads at once.
  BeamSearchResult search(const dvec3& source) const;
  /// One sentence for `explain` and the run's summary. `left_out` sequences at least, of more than
  /// `complete_depth` facets, were left out of a result.
  std::string guarantee(uint64_t left_out = 0, uint32_t complete_depth = ~0u) const;
  const BeamSearchOptions& options() const { return options_; }

 private:
  const FacetWorld* world_;
  const FacetKinds* kinds_;
  std::span<const scene::Wedge> wedges_;
  BeamSearchOptions options_;
  mutable std::shared_ptr<const BeamScene> scene_;  ///< kept between searches if nothing in it moves
};

}  // namespace greatx::rf
