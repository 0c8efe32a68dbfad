// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Candidates with a guarantee: the tree of image sources, each with the beam through the facet that it was mirrored
// at. Which facets a beam meets is decided by subdividing the beam's cross-section until each cell is settled
// (J. Warnock, "A hidden surface algorithm for computer generated halftone pictures", 1969), with one rule: a facet is
// dropped in a cell only if it is proven that nothing of it can be reached there. So the tree holds every sequence
// that has a path to any receiver whatever; what it holds beyond these costs time, never truth.
//
// Why beams and not rays that split: rays know only the directions they took. A beam is the whole set of directions,
// so the answer does not depend on any spacing, and its prunings (side of the mirror, overlap of pyramids, covered
// cells) are inequalities in fp64 with room for their roundings.
#pragma once

#include <cstdint>
#include <span>
#include <string>

#include "core/vec.h"
#include "rf/candidates.h"
#include "rf/facet_kind.h"
#include "rf/facet_world.h"
#include "scene/wedges.h"

namespace greatx::rf {

struct BeamSearchOptions {
  uint32_t max_depth = 3;  ///< reflections + walls passed
  uint32_t max_transmissions =
      0;  ///< walls passed, on the whole path (FacetKind::wall); not more than max_depth
  uint64_t capacity = 1u << 22;  ///< sequences kept; what is beyond is counted
  uint32_t threads = 0;          ///< 0: as many as the machine has. The result does not depend on it
  /// Facets of bodies other than 0 where they stand now; false: they neither reflect nor hide, as they may move away.
  bool moving_bodies = false;
  /// A body whose facets do not hide what its own antenna sees: the one that carries the source; 0: none.
  uint32_t source_body = 0;
  /// The visibility test lets a segment end within shared::visibility_tolerance behind a surface. Along an edge that a
  /// hidden facet shares with the one that hides it (the far wall of a house and its roof) this leaves a strip, at most
  /// ten tolerances wide, in which the hidden facet counts as lit. true: sequences that live in such strips alone are
  /// listed too. They lead into the inside of solids, and there are more of them than of all others.
  bool edge_strips = false;
};

struct BeamSearchResult {
  CandidateList
      list;  ///< canonical order, no duplicates, with windows; [0] is the empty sequence (line of sight)
  /// Sequences found, the empty one included. If there are more than `capacity`, the list ends with the last one that
  /// fits, and those of the depths after the one in which that happened have not been looked for: then this is the least
  /// number that there can be.
  uint64_t found = 0;
  uint64_t cells = 0;  ///< cells of beams looked at: what the search cost
  uint64_t overflow() const { return found - list.size(); }
};

class BeamSearch {
 public:
  /// `wedges` empty: none are looked for. All arguments are read by search() and must outlive it.
  BeamSearch(const FacetWorld& world, const FacetKinds& kinds, std::span<const scene::Wedge> wedges,
             const BeamSearchOptions& options);
  /// Every sequence of facets whose beam from `source` (local coordinates) is not proven dark.
  BeamSearchResult search(const dvec3& source) const;
  /// One sentence for `explain` and the run's summary.
  std::string guarantee() const;
  const BeamSearchOptions& options() const { return options_; }

 private:
  const FacetWorld* world_;
  const FacetKinds* kinds_;
  std::span<const scene::Wedge> wedges_;
  BeamSearchOptions options_;
};

}  // namespace greatx::rf
