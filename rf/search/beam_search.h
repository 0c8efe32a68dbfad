// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Finds candidates with a guarantee. The search follows the tree of image sources. The beam of an image goes
// through the lit part of the facet that mirrored it. The facets that a beam meets, and the regions where it
// meets them, are computed with polygons (beam_cells.h). A facet is dropped only if it lies outside the beam,
// or wholly behind other facets. Hence the tree holds every sequence that has a path to any receiver and
// keeps half a millimetre clear of edges. Further sequences in the tree cost time, but are never wrong
// results.
//
// The search uses beams and not rays that split, because rays know only the directions that they took. A beam
// is the whole set of directions, so that the result does not depend on any spacing. Its prunings (side of
// the mirror, overlap of pyramids, hidden polygons) are inequalities in fp64 with room for their roundings.
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
  uint32_t max_depth = 3;  ///< reflections and passed walls
  /// Walls (FacetKind::wall) that the whole path may pass; not more than max_depth.
  uint32_t max_transmissions = 0;
  uint64_t capacity = 1u << 22;  ///< number of sequences kept; sequences beyond it are counted
  uint32_t threads = 0;          ///< 0: one per core; the result does not depend on it
  /// Facets of bodies other than 0 take part at their present pose. If false, they neither reflect nor hide,
  /// because they may move away.
  bool moving_bodies = false;
  /// The body that carries the source, whose facets do not hide what its own antenna sees; 0: none.
  uint32_t source_body = 0;
  /// Paths are found for certain if they stay this far, in metres, from all edges that they do not touch: an
  /// obstacle in front of a facet may count as wider by this length. With 0, only hidden facets count as
  /// hidden. The search then finds twice as many sequences, most of which lie in the seams between facets
  /// that meet.
  double clearance_m = 5e-4;
  /// Largest number of facets of the sequences that the search looks for. Sequences that could go on still
  /// get beams. It is less than max_depth if another search takes the last steps (MovingSearch).
  uint32_t stop_depth = ~0u;
  /// Wedges are looked for behind sequences with fewer facets than this.
  uint32_t wedge_depth = ~0u;
};

/// Describes the beam of a sequence that can go on: it leaves the last facet through this rectangle of the
/// facet's plane, away from the image.
struct SequenceBeam {
  static constexpr uint32_t none = ~0u;
  dvec3 image{0.0};                ///< the source, mirrored at all facets
  dvec3 center{0.0};               ///< centre of the rectangle, local coordinates
  dvec3 half_a{0.0}, half_b{0.0};  ///< from the centre to the middles of the sides
  uint32_t walls = none;           ///< least number of walls passed; none if nothing can follow
};

struct BeamSearchResult {
  /// Canonical order, no duplicates, with windows. [0] is the empty sequence (line of sight).
  CandidateList list;
  /// Number of sequences found, with the empty one. If it exceeds `capacity`, the list ends with the last
  /// sequence that fits, and the search has stopped after the depth in which that happened. The number is
  /// then a lower bound.
  uint64_t found = 0;
  uint64_t cells = 0;  ///< number of cells of beams examined
  /// Number of polygons looked at for beams and of pairs of polygons compared: the cost of the search.
  uint64_t work = 0;
  /// Beams of the sequences [0, beams.size()) of the list, which are all that have fewer than max_depth
  /// facets. The beam of the empty sequence is everything: its rectangle has no meaning.
  std::vector<SequenceBeam> beams;
  uint64_t overflow() const { return found - list.size(); }
  /// Returns the number of facets up to which the list certainly has all sequences; ~0u if nothing was left
  /// out.
  uint32_t complete_depth() const;
};

class BeamSearch {
 public:
  /// If `wedges` is empty, the search looks for none. search() reads all arguments, which must outlive this
  /// object.
  BeamSearch(const FacetWorld& world, const FacetKinds& kinds, std::span<const scene::Wedge> wedges,
             const BeamSearchOptions& options);
  /// Searches in `scene`, for its wedges too if asked for. options.moving_bodies has no meaning. search() may
  /// be called by many threads.
  BeamSearch(std::shared_ptr<const BeamScene> scene, const BeamSearchOptions& options, bool wedges = false);
  /// Returns every sequence of facets whose beam from `source` (local coordinates) is not proven dark. Must
  /// not be called from two threads at once, unless the scene was given.
  BeamSearchResult search(const dvec3& source) const;
  /// Returns one sentence for `explain` and the run's summary. A result has left out at least `left_out`
  /// sequences, all with more than `complete_depth` facets.
  std::string guarantee(uint64_t left_out = 0, uint32_t complete_depth = ~0u) const;
  const BeamSearchOptions& options() const { return options_; }

 private:
  void check() const;

  const FacetWorld* world_ = nullptr;
  const FacetKinds* kinds_ = nullptr;
  std::span<const scene::Wedge> wedges_;
  bool with_wedges_ = false;
  BeamSearchOptions options_;
  mutable std::shared_ptr<const BeamScene> scene_;  ///< kept between searches if it cannot move
};

}  // namespace greatx::rf
