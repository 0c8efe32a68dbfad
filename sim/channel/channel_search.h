// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Finds the candidates of a channel and keeps them from tick to tick. Where an end and the world stand still,
// it searches once; at every tick it searches only for what moves.
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "rf/paths/path_solver.h"
#include "rf/search/beam_search.h"
#include "rf/search/candidate_search.h"
#include "rf/search/moving_search.h"
#include "sim/plan/effect_plan.h"

namespace greatx::sim {

/// Chooses the way to search for candidates, runs the searches, and turns candidates into geometric paths.
class ChannelSearch {
 public:
  /// Describes the ends of a channel, which decide the way to search.
  struct Ends {
    bool transmitter_rests = false, receivers_rest = false;
    uint32_t transmitter_body = 0;  ///< the body that carries the transmitter; 0: none
  };
  /// All arguments but `ends` must outlive this. If `gpu_scene` is null, only notes() may be called. Throws
  /// UserError if `search: once` is asked for and no end stands still, or if diffraction is on and candidates
  /// come from rays.
  ChannelSearch(scene::GpuScene* gpu_scene, const rf::RadioModel& model, const EffectPlan& plan,
                const ChannelConfig& config, const Ends& ends);

  /// Declares that the receivers are points at rest from now on, perhaps thousands, and may differ at each
  /// call of renew().
  void set_points();
  bool looks_ahead() const { return way_ == Way::every_tick && rays_.has_value(); }
  /// Records the rays of the next tick.
  void record_ahead(gpu::TickSlot& slot, const dvec3& transmitter);
  /// Called before the first tick of a sequence. The bodies of the model are in their poses at that tick,
  /// which are also `bodies`.
  void start(const dvec3& transmitter, std::span<const dvec3> receivers, std::span<const Pose> bodies);
  /// Updates the candidates for a tick. Called before the links of the tick are solved; the bodies of the
  /// model are in their poses at the tick.
  void renew(int64_t tick, const dvec3& transmitter, std::span<const dvec3> receivers);
  /// Returns every path that exists geometrically between the transmitter and receiver `index`, and the
  /// number of candidates that the searches left out. Changes nothing, so calls may run in parallel.
  rf::LinkGeometry geometry(size_t index, const rf::EndState& transmitter,
                            const rf::EndState& receiver) const;
  /// Returns the solver for the steps after the geometry, which do not depend on the candidates.
  const rf::PathSolver& solver() const { return fixed_.at(0); }

  void count(std::map<std::string, uint64_t>& counters) const;
  /// Returns notes as (name, text) pairs. `left_out` holds the omissions to report.
  std::vector<std::pair<std::string, std::string>> notes(const rf::LeftOut& left_out = {}) const;

 private:
  enum class Way {
    none,
    once_from_transmitter,
    once_from_receivers,
    between_ends,  ///< both ends move: at every tick, for these receivers alone
    every_tick     ///< at every tick from the transmitter, for any receiver
  };
  void choose(const EffectPlan& plan, const Ends& ends);
  void make_beams();
  bool once() const { return way_ == Way::once_from_transmitter || way_ == Way::once_from_receivers; }
  void grow_solvers(size_t count);
  void search_from(size_t index, const dvec3& source, std::span<const Pose> bodies, rf::Source end);
  rf::BeamSearchResult beams(const dvec3& source);
  void take(size_t index, rf::CandidateList list, const rf::LeftOut& left_out, const dvec3& source,
            rf::Source end);
  void renew_between(const dvec3& transmitter, std::span<const dvec3> receivers);
  void renew_moving(const dvec3& transmitter, std::span<const dvec3> receivers);

  const rf::RadioModel& model_;
  const ChannelConfig& config_;
  bool move_facets_;
  uint32_t walls_;  ///< the most walls that a path may pass
  uint32_t transmitter_body_;
  Way way_ = Way::none;
  std::optional<rf::BeamSearch> beams_;
  std::optional<rf::CandidateSearch> rays_;
  std::optional<rf::CandidateSearch::Pending> searching_;  ///< recorded in the submission before
  /// [sources]: the transmitter, or each receiver if searches start from the receivers. `fixed_` holds the
  /// candidates of the world at rest, or all candidates. `moving_` holds the candidates that moving bodies
  /// add at this tick; it is used if their facets reflect and an end rests.
  std::vector<rf::PathSolver> fixed_, moving_;
  std::vector<rf::LeftOut> left_out_;  ///< [fixed_] omissions of the search
  std::vector<rf::MovingSearch> moving_searches_;
  std::optional<rf::Seams> seams_;  ///< for the bodies at this tick
  int64_t renewed_tick_ = -1;
  uint64_t fixed_count_ = 0, candidates_ = 0, overflow_ = 0, cache_hits_ = 0;
};

}  // namespace greatx::sim
