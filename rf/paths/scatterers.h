// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Finds paths with a scattering in the middle: reflections lead from the source to a patch (prefix) and from
// there to the target (suffix). Prefixes come from the source's candidates, and suffixes from a search at the
// target. With PathLimits::scattering_budget the patches that their prefixes light are in a ScatterTree, and
// each target draws some of them, straight and over reflections (ReflectedTarget).
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "rf/config/path_limits.h"
#include "rf/geometry/candidates.h"
#include "rf/geometry/geometry.h"
#include "rf/geometry/path.h"
#include "rf/paths/exact_crossings.h"
#include "rf/paths/radio_model.h"
#include "rf/paths/reflected_target.h"
#include "rf/paths/scatter_draw.h"
#include "rf/paths/scatter_tree.h"
#include "rf/paths/scattering_patches.h"
#include "rf/search/beam_scene.h"

namespace greatx::rf {

inline Source opposite(Source end) {
  return end == Source::transmitter ? Source::receiver : Source::transmitter;
}

/// Turns a path that runs from the receiver, because the search did, into one from the transmitter.
void turn_to_transmitter(GeometricPath& path);

class Scatterers {
 public:
  /// Every call reads `model`, which must outlive this object. `moving_bodies`: facets of bodies other than 0
  /// reflect. Throws UserError as scattering_patches() does.
  Scatterers(const RadioModel& model, const PathLimits& limits, bool moving_bodies);

  /// Sets the sequences that lead to patches. `tree` is built from the same candidates. Patches outside the
  /// window of their facet are left out, because the beam does not reach them.
  void set_candidates(const CandidateList& candidates, const ImageTree& tree);
  /// Must be called when the source of `tree` or bodies have moved; the windows are then no longer used.
  void move(const ImageTree& tree);
  /// Appends every path with a scattering between the source of the last `tree` and `target`, from
  /// transmitter to receiver, in an unspecified order. `target_body` carries the target (0: none). Returns
  /// the number of sequences that the search for ways to patches left out.
  LeftOut solve(const ImageTree& tree, const dvec3& target, uint32_t target_body, uint32_t threads,
                std::vector<GeometricPath>& paths) const;

  /// The functions below serve paths with another bend beside the scattering. There must be a budget.
  const std::vector<Patch>& patches() const { return patches_; }
  /// Returns the patches that the source lights, with the ways that lead to them.
  const ScatterTree& lit() const { return tree_; }
  dvec3 center(const Patch& patch) const;
  /// Returns the number of reflections on the way to a patch of lit(), and appends them to a path.
  uint32_t reflections_to(const LitPatch& lit) const { return at_patches_.arrivals[lit.arrival].depth; }
  void append_way(const LitPatch& lit, GeometricPath& path) const;
  /// Returns the share of the power that passes everything at rest on a segment; 0: it is blocked.
  double passes_what_rests(const Segment& segment) const;
  /// Returns the mean share of the power of both polarizations that a facet reflects. A share that is too
  /// small costs accuracy, and one of 0 would lose power.
  double reflected(uint32_t facet, const dvec3& in) const;
  /// Describes a patch as a wave from `from` meets it that brings the power share / spread_m2 per area. None:
  /// it scatters nothing.
  std::optional<LitPatch> met(uint32_t patch, const dvec3& from, double share, double spread_m2) const;

 private:
  /// Holds for every facet the sequences that lead to it: [facets + 1] into `sequences`, ascending.
  struct Arrivals {
    std::vector<uint32_t> offsets, sequences;
  };
  /// Holds the whole way of a sequence from its end of the path to a patch.
  struct PatchArrival {
    uint32_t first = 0, depth = 0;  ///< range in PatchArrivals::facets and points, outwards
    dvec3 from{0.0};                ///< vertex before the patch
    double length_m = 0.0;          ///< unfolded length to the patch's centre
  };
  struct PatchArrivals {
    std::vector<uint32_t> offsets;  ///< [patches + 1] into arrivals
    std::vector<PatchArrival> arrivals;
    std::vector<uint32_t> facets;
    std::vector<dvec3> points;
    std::span<const PatchArrival> of(size_t patch) const {
      return std::span(arrivals).subspan(offsets[patch], offsets[patch + 1] - offsets[patch]);
    }
  };
  Arrivals arrivals_at_facets(const CandidateList& candidates, uint32_t most_reflections,
                              std::vector<PlaneWindow>& windows) const;
  PatchArrivals arrivals_at_patches(const Arrivals& at_facets, const std::vector<PlaneWindow>& windows,
                                    const ImageTree& tree) const;
  PatchArrivals straight_to_patches(const dvec3& from) const;
  void place_ways(const ImageTree& tree, const std::vector<PlaneWindow>& windows);
  double reaches(const PatchArrival& way, const Patch& patch, const dvec3& source) const;
  std::optional<LitPatch> lit_patch(uint32_t patch, uint32_t arrival, const dvec3& source) const;
  /// The way from the target to a patch, outwards from the target.
  struct Suffix {
    std::span<const uint32_t> facets;
    std::span<const dvec3> points;
    dvec3 from{0.0};        ///< vertex before the patch
    double length_m = 0.0;  ///< unfolded length to the patch's centre
  };
  void join(const ImageTree& tree, const dvec3& target, size_t patch, const PatchArrival& before,
            const Suffix& after, std::vector<GeometricPath>& paths) const;
  static Suffix suffix_of(const PatchArrivals& suffixes, const PatchArrival& after);
  Suffix straight_from(const dvec3& target, const LitPatch& lit) const;
  uint32_t most_after() const;
  CandidateList ways_from(const dvec3& target, uint32_t body, uint32_t most_facets, uint32_t threads,
                          LeftOut& left_out) const;
  PatchArrivals ways_to(const ImageTree& tree, const dvec3& target, uint32_t body, uint32_t threads,
                        LeftOut& left_out) const;
  /// A patch of the tree and a way with reflections that leads from the target to it.
  struct Bounce {
    uint32_t patch = 0, suffix = 0;
  };
  std::vector<SingleScattering> bounces(const PatchArrivals& suffixes, std::vector<Bounce>& pairs) const;
  void draw(const ImageTree& tree, const dvec3& target, const PatchArrivals& suffixes,
            std::vector<GeometricPath>& paths) const;
  void draw(const ImageTree& tree, const dvec3& target, const ReflectedTarget& views,
            std::vector<GeometricPath>& paths) const;
  double sight_over(const ReflectedTarget& views, uint32_t view, const LitPatch& patch) const;
  double sight_from(const dvec3& target, const LitPatch& patch) const;

  const RadioModel* model_;
  PathLimits limits_;
  bool moving_bodies_;
  std::vector<Patch> patches_;
  Arrivals at_facets_;
  PatchArrivals at_patches_;
  std::optional<ExactCrossings> at_rest_;   ///< what never moves, as obstacles; set if there is a budget
  ScatterTree tree_;                        ///< of `at_patches_`, if there is a budget
  std::optional<ReflectedShares> shares_;   ///< set if there is a budget, and reflections behind a scattering
  std::shared_ptr<const BeamScene> beams_;  ///< set if these are searched in a scene that does not move
};

}  // namespace greatx::rf
