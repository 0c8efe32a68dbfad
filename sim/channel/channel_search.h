// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// How a channel's candidates are found and kept from tick to tick: once where an end and the world stand
// still, every tick only for what moves.
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

class ChannelSearch {
 public:
  /// What decides between the ways.
  struct Ends {
    bool transmitter_rests = false, receivers_rest = false;
    uint32_t transmitter_body = 0;  ///< that carries it; 0: none
  };
  /// All arguments but `ends` must outlive this. `gpu_scene` null: notes() alone may be called. Throws
  /// UserError if `search: once` is asked for and no end stands still, or diffraction is on and candidates
  /// come from rays.
  ChannelSearch(scene::GpuScene* gpu_scene, const rf::RadioModel& model, const EffectPlan& plan,
                const ChannelConfig& config, const Ends& ends);

  /// From now on the receivers are points at rest, perhaps thousands, others at each call of renew().
  void set_points();
  bool looks_ahead() const { return way_ == Way::every_tick && rays_.has_value(); }
  /// Rays of the tick after this one.
  void record_ahead(gpu::TickSlot& slot, const dvec3& transmitter);
  /// Before the first tick of a sequence; bodies of the model are where they are then, `bodies` as well.
  void start(const dvec3& transmitter, std::span<const dvec3> receivers, std::span<const Pose> bodies);
  /// Before the links of a tick are solved, bodies of the model being where they are.
  void renew(int64_t tick, const dvec3& transmitter, std::span<const dvec3> receivers);
  /// Every chain that exists geometrically between the transmitter and receiver `index`, and what searches
  /// left out of them. Writes nothing.
  rf::LinkGeometry geometry(size_t index, const rf::EndState& transmitter,
                            const rf::EndState& receiver) const;
  /// For the steps after the geometry, which know of no candidates.
  const rf::PathSolver& solver() const { return fixed_.at(0); }

  void count(std::map<std::string, uint64_t>& counters) const;
  /// `left_out`: of what the notes are about.
  std::vector<std::pair<std::string, std::string>> notes(const rf::LeftOut& left_out = {}) const;

 private:
  enum class Way {
    none,
    once_from_transmitter,
    once_from_receivers,
    between_ends,  ///< both move: every tick, for these receivers alone
    every_tick     ///< from the transmitter, for any receiver
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
  uint32_t walls_;  ///< that may be passed
  uint32_t transmitter_body_;
  Way way_ = Way::none;
  std::optional<rf::BeamSearch> beams_;
  std::optional<rf::CandidateSearch> rays_;
  std::optional<rf::CandidateSearch::Pending> searching_;  ///< recorded with the tick before
  /// [sources]: the transmitter, or each receiver if they are. `fixed_` holds what the world at rest has, or
  /// everything; `moving_`, if facets of moving bodies reflect and an end rests, what they add at this tick.
  std::vector<rf::PathSolver> fixed_, moving_;
  std::vector<rf::LeftOut> left_out_;  ///< [fixed_] of the search
  std::vector<rf::MovingSearch> moving_searches_;
  std::optional<rf::Seams> seams_;  ///< of this tick
  int64_t renewed_tick_ = -1;
  uint64_t fixed_count_ = 0, candidates_ = 0, overflow_ = 0, cache_hits_ = 0;
};

}  // namespace greatx::sim
