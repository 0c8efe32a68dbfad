// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Finds paths with a diffraction or a scattering in the middle: reflections lead from the source to a wedge
// or a patch (prefix) and from there to the target (suffix). Prefixes come from the source's candidates, and
// suffixes from a search at the target: that of EdgeSearch for wedges, a whole one for patches.
#pragma once

#include <compare>
#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include "rf/config/path_limits.h"
#include "rf/geometry/candidates.h"
#include "rf/geometry/geometry.h"
#include "rf/geometry/path.h"
#include "rf/paths/edge_search.h"
#include "rf/paths/radio_model.h"
#include "rf/paths/wedge_arrivals.h"

namespace greatx::rf {

/// Holds a piece of a facet that scatters as a whole.
struct Patch {
  uint32_t facet = 0;
  uint32_t number = 0;  ///< number of the patch on its facet
  dvec3 center{0.0};    ///< in the frame of its body
  double area_m2 = 0.0;
};

/// Cuts every facet whose material scatters into triangles with sides of at most `side_m`, in the order of
/// the facet's triangles. Each cut halves the longest side. Throws UserError if there are more than `most`
/// patches.
std::vector<Patch> scattering_patches(const scene::Scene& scene, const FacetKinds& kinds, double side_m,
                                      size_t most = 10'000'000);

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
  struct Chain;
  struct WedgeJoin;
  Arrivals arrivals_at_facets(const CandidateList& candidates, uint32_t most_reflections,
                              std::vector<PlaneWindow>& windows) const;
  PatchArrivals arrivals_at_patches(const Arrivals& at_facets, const std::vector<PlaneWindow>& windows,
                                    const ImageTree& tree) const;
  PatchArrivals straight_to_patches(const dvec3& from) const;
  dvec3 center(const Patch& patch) const;
  bool diffract(const Chain& chain, WedgeJoin& join) const;
  void scatter(const ImageTree& tree, const dvec3& target, size_t patch, const PatchArrivals& suffixes,
               std::vector<GeometricPath>& paths) const;
  /// A wedge and a sequence that leads from the target to it.
  struct Meeting {
    uint32_t wedge = 0, suffix = 0;
    auto operator<=>(const Meeting&) const = default;
  };
  uint32_t most_before(uint32_t after) const;
  std::vector<Meeting> meetings(const CandidateList& suffixes) const;
  LeftOut solve_wedges(const ImageTree& tree, const Target& target, uint32_t threads,
                       std::vector<GeometricPath>& paths) const;
  LeftOut solve_patches(const ImageTree& tree, const Target& target, uint32_t threads,
                        std::vector<GeometricPath>& paths) const;
  void join_at(std::span<const Meeting> at, const ImageTree& tree, const ImageTree& suffixes,
               std::vector<GeometricPath>& paths) const;

  const RadioModel* model_;
  PathLimits limits_;
  bool moving_bodies_;
  std::vector<Patch> patches_;
  std::shared_ptr<EdgeSearch> edges_;
  bool search_target_ = false;          ///< reflections may follow a diffraction
  std::optional<ImageTree> edge_tree_;  ///< of find_edge_ways(); empty: the tree of the candidates
  LeftOut edge_left_out_;
  WedgeArrivals at_wedges_;
  Arrivals at_facets_;
  PatchArrivals at_patches_;
};

}  // namespace greatx::rf
