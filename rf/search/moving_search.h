// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Candidates at a tick at which something has moved, between a source and a few known targets, from the tree
// of beams that the world at rest has (BeamSearch, moving bodies absent). Three facts make it cheap:
//
// - What moves can only take paths of the world at rest away, and that is seen when segments are traced. So
//   the sequences of
//   facets at rest never change, and only those with a moving facet are looked for.
// - A moving facet enters a sequence in the beam of a sequence at rest: it is cut to that beam, and what is
//   left of it is a
//   beam of its own.
// - The last facet of a sequence needs no beam: it is reached from a beam only if the target's mirror image
//   in it lies
//   inside that beam. The images of a target in all facets are points in a tree of boxes, and each beam asks
// for those inside.
//
// Nothing is taken for hidden here: bounds are sides of mirrors, pyramids and rectangles around facets, each
// with far more room than fp64 rounds. So the list has every sequence with a path to one of the targets, if
// the tree has its beginnings.
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
#include "rf/search/seams.h"

namespace greatx::rf {

struct MovingSearchOptions {
  uint32_t max_depth = 3;          ///< as the tree's
  uint32_t max_transmissions = 0;  ///< as the tree's
  bool moving_bodies = true;       ///< facets of bodies other than 0 reflect
  uint32_t threads = 0;            ///< 0: as many as the machine has. The result does not depend on it
};

class MovingSearch {
 public:
  /// `world` and `kinds` are read by every call and must outlive this.
  MovingSearch(const FacetWorld& world, const FacetKinds& kinds, const MovingSearchOptions& options);
  /// What `source` sees of the world at rest: a search without moving bodies, to the same depth. For all() it
  /// may have stopped earlier (BeamSearchOptions::stop_depth): what follows is then found by bounds alone,
  /// like what follows a moving facet. For moving() it may have stopped one level earlier.
  void set_tree(const BeamSearchResult& tree, const dvec3& source);
  bool has_tree() const { return !beams_.empty() || options_.max_depth == 0; }

  /// Every sequence from the source with a moving facet, where bodies stand now, that may lead to one of
  /// `targets` (local coordinates). Canonical, without windows, without the empty one.
  CandidateList moving(std::span<const dvec3> targets) const { return search(targets, false); }
  /// Those of facets at rest as well, and the empty one.
  CandidateList all(std::span<const dvec3> targets) const { return search(targets, true); }

  /// For the paths of these sequences, while bodies stand where they are now.
  Seams seams() const;
  /// One sentence for the run's summary: of moving(), or of all().
  std::string guarantee(bool fixed_too) const;
  const MovingSearchOptions& options() const { return options_; }

 private:
  struct Walk;
  CandidateList search(std::span<const dvec3> targets, bool fixed_too) const;

  const FacetWorld* world_;
  const FacetKinds* kinds_;
  MovingSearchOptions options_;
  std::shared_ptr<const BeamScene> fixed_;  ///< facets at rest; copies share it
  dvec3 source_{0.0};
  std::vector<SequenceBeam> beams_;  ///< of the tree's sequences that have fewer than max_depth facets
  CandidateList sequences_;          ///< [beams_]
  uint32_t tree_depth_ = 0;
  std::vector<uint32_t> fixed_facet_;  ///< [facets of the world]: index in `fixed_`; ~0u: moves, or foliage
};

}  // namespace greatx::rf
