// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Finds the reflections by which an end may reach wedges. A path with a diffraction has two such ways, one
// from each end, and they meet at the edge. The way from the source may also come from the source's own
// candidates, if these list wedges (WedgeArrivals).
//
// The end's tree of beams (BeamSearch) is cut off where only a wedge can follow. The wedges that the end sees
// itself are found exactly. Which wedges the beams behind reflections reach is asked by the pyramids of the
// beams alone, and not by what stands before the wedges: joining at the edge refuses nearly all pairs, and
// the crossings see the rest. A search that followed the last beams as well would take five to eighteen times
// as long.
#pragma once

#include <cstdint>
#include <memory>
#include <mutex>

#include "core/vec.h"
#include "rf/config/path_limits.h"
#include "rf/geometry/candidates.h"
#include "rf/paths/edge_pairs.h"
#include "rf/paths/radio_model.h"
#include "rf/search/beam_scene.h"
#include "rf/search/kept_answers.h"

namespace greatx::rf {

/// Holds the sequences of reflections from an end towards wedges, with the wedges that each may reach.
struct EdgeWays {
  CandidateList list;  ///< canonical order; [0] is the empty sequence
  LeftOut left_out;
};

class EdgeSearch {
 public:
  /// `model` must outlive this object. `moving_bodies`: facets of bodies other than 0 reflect and hide.
  EdgeSearch(const RadioModel& model, const PathLimits& limits, bool moving_bodies);

  /// Must be called when bodies of the model may have moved, and not while others ask. Answers stay if no
  /// body has.
  void move();
  /// Returns what a search at `end` finds, whose `body` hides nothing from it (0: none). The last answers are
  /// kept if `keep`. Many threads may call this.
  std::shared_ptr<const EdgeWays> from(const dvec3& end, uint32_t body, uint32_t threads, bool keep);
  /// Returns which edges may see which, wherever bodies move. It is made when it is asked for first.
  EdgePairs& pairs();

 private:
  struct Question {
    dvec3 end{0.0};
    uint32_t body = 0;
    bool operator==(const Question&) const = default;
  };
  bool same_poses();
  static constexpr size_t most_answers = 64;  ///< one takes a megabyte, more or less
  EdgeWays search(const dvec3& end, uint32_t body, uint32_t threads) const;

  const RadioModel* model_;
  PathLimits limits_;
  bool moving_bodies_;
  std::shared_ptr<const BeamScene> scene_;
  std::vector<Pose> poses_;  ///< [bodies - 1] of `scene_`, if bodies move
  std::mutex pairs_mutex_;
  std::unique_ptr<EdgePairs> pairs_;
  KeptAnswers<Question, EdgeWays> answers_{most_answers};
};

}  // namespace greatx::rf
