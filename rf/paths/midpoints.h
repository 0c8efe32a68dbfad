// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Finds paths with a diffraction or a scattering in the middle: reflections lead from the source to a wedge
// or a patch (prefix) and from there to the target (suffix). Prefixes come from the source's candidates, and
// suffixes from a search at the target: that of EdgeSearch for wedges, a whole one for patches (Scatterers).
// Paths with a scattering and another bend are drawn (IndirectLight, scatter_over_edges()).
#pragma once

#include <compare>
#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include "rf/config/path_limits.h"
#include "rf/edges/corners.h"
#include "rf/geometry/candidates.h"
#include "rf/geometry/geometry.h"
#include "rf/geometry/path.h"
#include "rf/paths/edge_search.h"
#include "rf/paths/indirect_light.h"
#include "rf/paths/radio_model.h"
#include "rf/paths/scatterers.h"
#include "rf/paths/wedge_arrivals.h"

namespace greatx::rf {

class Midpoints {
 public:
  /// Every call reads `model`, which must outlive this object. If reflections may follow a diffraction or a
  /// scattering, solve() searches at every target. `moving_bodies`: facets of bodies other than 0 reflect.
  /// `shared` may serve other solvers of the same model and limits; null: this object makes its own if it
  /// needs one.
  Midpoints(const RadioModel& model, const PathLimits& limits, bool moving_bodies,
            std::shared_ptr<EdgeSearch> shared);

  /// Sets the sequences that lead to wedges and patches. `tree` is built from the same candidates, which list
  /// wedges if diffraction is on. Patches outside the window of their facet are left out, because the beam
  /// does not reach them.
  void set_candidates(const CandidateList& candidates, const ImageTree& tree);
  /// Searches for the ways from the source of `tree`, which `body` carries (0: none), to wedges. They take
  /// the place of those that set_candidates() set. There must be a `shared` search.
  void find_edge_ways(const ImageTree& tree, uint32_t body, uint32_t threads);
  /// Must be called when the source of `tree` or bodies have moved; the windows are then no longer used.
  void move(const ImageTree& tree);
  /// Describes the target of solve().
  struct Target {
    dvec3 position{0.0};
    uint32_t body = 0;  ///< the body that carries it; 0: none
    bool keep = false;  ///< it may be asked for again
  };
  /// Appends every path with a diffraction or scattering between the source of the last `tree` and `target`,
  /// from transmitter to receiver, in an unspecified order. Returns the number of sequences that the searches
  /// for ways to wedges and patches left out.
  LeftOut solve(const ImageTree& tree, const Target& target, uint32_t threads,
                std::vector<GeometricPath>& paths) const;

 private:
  struct Chain;
  struct WedgeJoin;
  bool diffract(const Chain& chain, WedgeJoin& join) const;
  bool diffract_at(const Chain& chain, Corner corner, WedgeJoin& join) const;
  bool bend(const Chain& chain, const Interaction& middle, const dvec3& point, WedgeJoin& join) const;
  /// A wedge and a sequence that leads from the target to it.
  struct Meeting {
    uint32_t wedge = 0, suffix = 0;
    auto operator<=>(const Meeting&) const = default;
  };
  uint32_t most_before(uint32_t after) const;
  std::vector<Meeting> meetings(const CandidateList& suffixes) const;
  std::shared_ptr<const EdgeWays> ways_to_edges(const Target& target, uint32_t threads) const;
  void solve_wedges(const ImageTree& tree, const Target& target, const EdgeWays& ways, uint32_t threads,
                    std::vector<GeometricPath>& paths) const;
  void scatter_and_bend(const ImageTree& tree, const Target& target, const EdgeWays* ways,
                        std::vector<GeometricPath>& paths) const;
  void add_over_two_edges(const ImageTree& tree, const ImageTree& images, const EdgeWays& ways,
                          uint32_t threads, std::vector<GeometricPath>& paths) const;
  void join_at(std::span<const Meeting> at, const ImageTree& tree, const ImageTree& suffixes,
               std::vector<GeometricPath>& paths) const;

  const RadioModel* model_;
  PathLimits limits_;
  std::shared_ptr<EdgeSearch> edges_;
  bool search_target_ = false;  ///< reflections or another edge may follow a diffraction
  bool two_edges_ = false;
  double most_excess_m_ = 0.0;          ///< of a path over the end of an edge; 0: ends do not diffract
  std::optional<ImageTree> edge_tree_;  ///< of find_edge_ways(); empty: the tree of the candidates
  LeftOut edge_left_out_;
  WedgeArrivals at_wedges_;
  std::optional<Scatterers> scatterers_;  ///< set if scattering is on
  bool scatter_beside_edges_ = false;
  std::unique_ptr<IndirectLight> indirect_;  ///< set if a scattering may come with another bend
};

}  // namespace greatx::rf
