// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Finds candidates between a source and a few known targets at a tick at which something has moved. It starts
// from the tree of beams of the world at rest (BeamSearch without moving bodies). Three facts make the search
// cheap:
// - A moving body can only remove paths of the world at rest, and tracing the segments detects that. Hence
//   the sequences of facets at rest never change, and the search looks only for sequences with a moving
//   facet.
// - A moving facet enters a sequence in the beam of a sequence at rest. It is cut to that beam, and the
//   remaining part is a beam of its own.
// - The last facet of a sequence needs no beam: a beam reaches the target over it only if the target's mirror
//   image in it lies inside the beam. The images of a target in all facets are points in a tree of boxes, and
//   each beam queries the points inside.
//
// The search treats nothing as hidden, but for the last facets in all(): a path comes to its target from a
// facet that the target sees (FixedFacets). The other bounds are sides of mirrors, pyramids and rectangles
// around facets, each with far more room than the rounding of fp64. Therefore the list has every sequence
// with a path to one of the targets, provided that the tree has the beginning of the sequence.
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "core/vec.h"
#include "rf/facets/facet_kind.h"
#include "rf/facets/facet_world.h"
#include "rf/geometry/candidates.h"
#include "rf/search/beam_scene.h"
#include "rf/search/beam_search.h"
#include "rf/search/fixed_facets.h"
#include "rf/search/seams.h"

namespace greatx::rf {

struct MovingSearchOptions {
  uint32_t max_depth = 3;          ///< as for the tree
  uint32_t max_transmissions = 0;  ///< as for the tree
  bool moving_bodies = true;       ///< facets of bodies other than 0 reflect
  uint32_t threads = 0;            ///< 0: one per core; the result does not depend on it
};

class MovingSearch {
 public:
  /// Every call reads `world` and `kinds`, which must outlive this object. `fixed` may be shared with other
  /// searches in the same world; null: the search makes its own.
  MovingSearch(const FacetWorld& world, const FacetKinds& kinds, const MovingSearchOptions& options,
               std::shared_ptr<FixedFacets> fixed = nullptr);
  /// Sets the result of a search from `source` in the world at rest: without moving bodies, to the same
  /// depth. For all() that search may have stopped earlier (BeamSearchOptions::stop_depth); bounds alone then
  /// find the rest, as they do after a moving facet. For moving() it may have stopped one level earlier.
  void set_tree(const BeamSearchResult& tree, const dvec3& source);
  bool has_tree() const { return !beams_.empty() || options_.max_depth == 0; }

  /// Returns every sequence from the source that contains a moving facet, at the present poses of bodies, and
  /// that may lead to one of `targets` (local coordinates). The list is canonical, without windows and
  /// without the empty sequence.
  CandidateList moving(std::span<const dvec3> targets) const { return search(targets, false); }
  /// Returns these sequences, those of facets at rest, and the empty sequence.
  CandidateList all(std::span<const dvec3> targets) const { return search(targets, true); }

  /// Returns the seams for the paths of these sequences. They hold while bodies keep their present poses.
  Seams seams() const;
  /// Returns one sentence for the run's summary about all() if `fixed_too`, else about moving().
  std::string guarantee(bool fixed_too) const;
  const MovingSearchOptions& options() const { return options_; }

 private:
  struct Walk;
  CandidateList search(std::span<const dvec3> targets, bool fixed_too) const;
  /// Returns the most walls that may stand before the last reflection of a path.
  uint32_t walls() const;

  const FacetWorld* world_;
  const FacetKinds* kinds_;
  MovingSearchOptions options_;
  std::shared_ptr<FixedFacets> fixed_;  ///< copies share it
  dvec3 source_{0.0};
  std::vector<SequenceBeam> beams_;  ///< of the tree's sequences with fewer than max_depth facets
  CandidateList sequences_;          ///< [beams_]
  uint32_t tree_depth_ = 0;
};

}  // namespace greatx::rf
