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
#include "sim/channel/ends.h"
#include "sim/plan/effect_plan.h"

namespace greatx::sim {

/// Holds what the searches from several transmitters share. Everything is made when it is asked for first.
class SharedSearches {
 public:
  explicit SharedSearches(const rf::RadioModel& model) : model_(model) {}
  std::shared_ptr<rf::FixedFacets> fixed_facets() {
    if (!fixed_) fixed_ = std::make_shared<rf::FixedFacets>(model_.facets, model_.kinds);
    return fixed_;
  }
  /// Returns the search for ways to edges under these limits. A channel and its legs may have others.
  std::shared_ptr<rf::EdgeSearch> edges(const rf::PathLimits& limits, bool moving_bodies) {
    for (const Edges& known : edges_)
      if (known.limits.max_depth == limits.max_depth &&
          known.limits.max_transmissions == limits.max_transmissions &&
          known.limits.max_reflections_beside_diffraction == limits.max_reflections_beside_diffraction &&
          known.limits.max_diffractions == limits.max_diffractions && known.moving_bodies == moving_bodies)
        return known.search;
    edges_.push_back(
        {limits, moving_bodies, std::make_shared<rf::EdgeSearch>(model_, limits, moving_bodies)});
    return edges_.back().search;
  }

 private:
  const rf::RadioModel& model_;
  std::shared_ptr<rf::FixedFacets> fixed_;
  struct Edges {
    rf::PathLimits limits;
    bool moving_bodies;
    std::shared_ptr<rf::EdgeSearch> search;
  };
  std::vector<Edges> edges_;
};

/// Chooses the way to search for candidates, runs the searches, and turns candidates into geometric paths.
class ChannelSearch {
 public:
  /// The ends decide the way to search. All arguments but `ends` must outlive this. If `gpu_scene` is null,
  /// only notes() may be called. Throws UserError if `search: once` is asked for and no end stands still, or
  /// if diffraction is on and candidates come from rays.
  /// `shared` serves the searches from all transmitters of the channel; null: the search makes its own.
  ChannelSearch(scene::GpuScene* gpu_scene, const rf::RadioModel& model, const EffectPlan& plan,
                const ChannelConfig& config, const ChannelEnds& ends, SharedSearches* shared = nullptr);

  /// Declares that the receivers are points at rest from now on, perhaps thousands, and may differ at each
  /// call of renew().
  void set_points();
  bool looks_ahead() const;
  /// Records the rays of the next tick. Called if looks_ahead().
  void record_ahead(gpu::TickSlot& slot, const dvec3& transmitter, std::span<const dvec3> receivers);
  /// Called before the first tick of a sequence. The bodies of the model are in their poses at that tick,
  /// which are also `bodies`.
  void start(const dvec3& transmitter, std::span<const dvec3> receivers, std::span<const Pose> bodies);
  /// Updates the candidates for a tick. Called before the links of the tick are solved; the bodies of the
  /// model are in their poses at the tick, which are also `bodies`.
  void renew(int64_t tick, const dvec3& transmitter, std::span<const dvec3> receivers,
             std::span<const Pose> bodies);
  /// Returns every path that exists geometrically between the transmitter and receiver `index`, and the
  /// number of candidates that the searches left out. Uses `threads` threads. Calls may run in parallel.
  rf::LinkGeometry geometry(size_t index, const rf::EndState& transmitter, const rf::EndState& receiver,
                            uint32_t threads) const;
  /// Returns the solver for the steps after the geometry of receiver `index`, which do not depend on the
  /// candidates.
  const rf::PathSolver& solver(size_t index) const { return fixed_.at(source_of(index)); }

  void count(std::map<std::string, uint64_t>& counters) const;
  /// Returns notes as (name, text) pairs. `left_out` holds the omissions to report.
  std::vector<std::pair<std::string, std::string>> notes(const rf::LeftOut& left_out = {}) const;

 private:
  enum class Way {
    none,
    once_from_transmitter,
    once_from_receivers,
    between_ends,  ///< both ends move: at every tick, for these receivers alone
    every_tick,    ///< at every tick from the transmitter, for any receiver
    by_link        ///< from the end of each link that searched_from() names, once if it rests
  };
  /// An end that candidates are searched from.
  struct SearchSource {
    rf::Source end = rf::Source::transmitter;
    size_t receiver = 0;  ///< if that is the end
    uint32_t body = 0;    ///< the body that carries the end; 0: none
    bool kept = false;    ///< the candidates are searched once
  };
  void choose(const EffectPlan& plan, const ChannelEnds& ends);
  void choose_by_link(const ChannelEnds& ends);
  void list_sources(const ChannelEnds& ends);
  static const dvec3& position_of(const SearchSource& from, const dvec3& transmitter,
                                  std::span<const dvec3> receivers) {
    return from.end == rf::Source::transmitter ? transmitter : receivers[from.receiver];
  }
  const char* by_link_times() const;
  void note_two_bends(std::vector<std::pair<std::string, std::string>>& notes) const;
  size_t source_of(size_t receiver) const { return source_of_.empty() ? 0 : source_of_[receiver]; }
  void make_beams();
  bool once() const { return way_ == Way::once_from_transmitter || way_ == Way::once_from_receivers; }
  void grow_solvers(size_t count);
  void search_from(size_t index, const dvec3& source, std::span<const Pose> bodies);
  rf::BeamSearchResult beams(const SearchSource& from, const dvec3& source);
  void take(size_t index, rf::CandidateList list, const rf::LeftOut& left_out, const dvec3& source);
  void renew_between(const dvec3& transmitter, std::span<const dvec3> receivers);
  void renew_source(size_t index, const dvec3& source);
  void renew_moving(const dvec3& transmitter, std::span<const dvec3> receivers);

  const rf::RadioModel& model_;
  const ChannelConfig& config_;
  SharedSearches* shared_;
  bool move_facets_;
  uint32_t walls_;            ///< the most walls that a path may pass
  SearchSource transmitter_;  ///< as a source
  Way way_ = Way::none;
  std::optional<rf::BeamSearch> beams_;
  std::optional<rf::CandidateSearch> rays_;
  std::vector<SearchSource> sources_;
  std::vector<size_t> source_of_;  ///< [receivers]; empty: the only source serves all
  /// [sources], or empty: recorded in the submission before.
  std::vector<std::optional<rf::CandidateSearch::Pending>> searching_;
  /// [sources] `fixed_` holds the candidates of the world at rest, or all candidates. `moving_` holds the
  /// candidates that moving bodies add at this tick; it is used if their facets reflect and an end rests.
  std::vector<rf::PathSolver> fixed_, moving_;
  std::vector<rf::LeftOut> left_out_;       ///< [fixed_] omissions of the search
  std::vector<bool> fields_from_receiver_;  ///< [receivers] between_ends: of paths over edges
  bool points_ = false;
  std::vector<rf::MovingSearch> moving_searches_;
  std::optional<rf::Seams> seams_;  ///< for the bodies at this tick
  int64_t renewed_tick_ = -1;
  uint64_t fixed_count_ = 0, candidates_ = 0, overflow_ = 0, cache_hits_ = 0;
};

}  // namespace greatx::sim
