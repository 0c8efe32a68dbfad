// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Finds the reflections by which a target may reach wedges: the other side of a path with a diffraction. The
// source's search knows what leads to a wedge (WedgeArrivals); this one starts at the target, and the paths
// meet at the edge.
//
// The target's tree of beams (BeamSearch) is cut off where only a wedge can follow. Whether the last beam
// reaches a wedge is asked by the pyramid of the beam alone, and not by what stands before the wedge: joining
// at the edge refuses nearly all pairs, and the crossings see the rest. A search that followed the last beams
// as well would take four to five times as long.
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "core/vec.h"
#include "rf/config/path_limits.h"
#include "rf/geometry/candidates.h"
#include "rf/paths/radio_model.h"
#include "rf/search/beam_scene.h"
#include "rf/search/beam_search.h"

namespace greatx::rf {

/// Holds the sequences of reflections from a target towards wedges.
struct Suffixes {
  CandidateList list;               ///< canonical order; [0] is the empty sequence
  std::vector<SequenceBeam> beams;  ///< [list]
  LeftOut left_out;
};

/// Keeps the suffixes of one target for as long as it stands still among facets that do.
struct SuffixMemory {
  std::shared_ptr<const BeamScene> scene;  ///< in which they were searched; null: none are kept
  dvec3 target{0.0};
  uint32_t body = 0;
  Suffixes suffixes;
};

class SuffixSearch {
 public:
  /// `model` must outlive this object. `moving_bodies`: facets of bodies other than 0 reflect and hide.
  SuffixSearch(const RadioModel& model, const PathLimits& limits, bool moving_bodies);

  /// Must be called before from(), and again when bodies of the model have moved.
  void move();
  /// Returns what a search at `target` finds, whose `body` hides nothing from it (0: none). It is kept in
  /// `memory`, and nothing is searched for if the same is there already. May be called by many threads, with
  /// a memory each.
  const Suffixes& from(const dvec3& target, uint32_t body, uint32_t threads, SuffixMemory& memory) const;

  /// Sets `wedges` to those that a sequence of at least one reflection may lead to, ascending. Wedges whose
  /// faces have made the last reflection are left out, because that reflection is part of the wedge's field.
  void wedges_of(const Suffixes& suffixes, size_t sequence, std::vector<uint32_t>& wedges) const;

 private:
  Suffixes search(const dvec3& target, uint32_t body, uint32_t threads) const;

  const RadioModel* model_;
  PathLimits limits_;
  bool moving_bodies_;
  std::shared_ptr<const BeamScene> scene_;
};

}  // namespace greatx::rf
