// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Computes the paths and fields of the links from one source (a transmitter, or a receiver that stands still)
// to any number of targets. There are three steps around the GPU's answer to what blocks the paths:
//
//   geometry(target) ─► add_segments() ─► CrossingPass ─► finish()
//
// Each step reads the solver and writes nothing to it. Hence targets may be solved in parallel, and a
// target's paths depend on that target alone.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "rf/config/path_limits.h"
#include "rf/geometry/geometry.h"
#include "rf/geometry/path.h"
#include "rf/paths/crossings.h"
#include "rf/paths/midpoints.h"
#include "rf/paths/radio_model.h"

namespace greatx::rf {

/// Describes an end of a link at a tick, in local coordinates along local axes.
struct EndState {
  dvec3 position{0.0}, velocity{0.0};
  dquat orientation{1.0, 0.0, 0.0, 0.0};
  uint32_t body = 0;  ///< body that carries the end and does not hide it; 0: none
};

/// Holds a link's paths before the GPU has answered.
struct LinkGeometry {
  std::vector<GeometricPath> paths;  ///< canonical order; reflections, diffraction, scattering; no walls yet
  uint64_t overflow = 0;             ///< number of paths beyond PathLimits::max_paths
  LeftOut searched = {};             ///< sequences that the search at the target left out
};

/// Removes the paths of a link beyond `most` and counts them: scattering first, then diffraction, and longer
/// chains before shorter ones. The paths are in canonical order before and after.
void keep_most(LinkGeometry& link, uint64_t most);

class PathSolver {
 public:
  /// Every call reads `model`, which must outlive the solver. `moving_bodies`: facets of bodies other than 0
  /// reflect.
  /// `edges` may be shared by solvers of the same model and limits; null: the solver makes its own if it
  /// needs one.
  PathSolver(const RadioModel& model, const PathLimits& limits, bool moving_bodies = false,
             std::shared_ptr<EdgeSearch> edges = nullptr);

  /// Builds the images of `source` for these candidates, which run from the source.
  void set_candidates(const CandidateList& candidates, const dvec3& source, Source end);
  /// Searches for the ways from the source to wedges, if the candidates list no wedges. `body` carries the
  /// source (0: none). Must be called after set_candidates().
  void find_edge_ways(uint32_t body, uint32_t threads);
  /// Must be called when the source or bodies of the model have moved. The candidates stay, but their windows
  /// are dropped.
  void move_source(const dvec3& source);

  /// Returns every chain that exists geometrically between the source and `target`, on `threads` threads (0:
  /// usable_cores()). `keep`: the target may be asked for again, at rest or by another solver.
  LinkGeometry geometry(const EndState& target, uint32_t threads = 1, bool keep = false) const;
  /// Appends the segments of the paths, one path after the other.
  void add_segments(std::span<const GeometricPath> paths, const EndState& transmitter,
                    const EndState& receiver, std::vector<Segment>& segments) const;
  /// Turns walls into interactions, drops blocked paths and paths beyond the limits, and returns the fields
  /// of the other paths in canonical order. `crossings` are the answers to the segments of these paths.
  /// `world` is a copy of the model's facets as they stood when the geometry was solved; the model's own
  /// facets may have moved since. The fields are computed on `threads` threads (0: usable_cores()).
  std::vector<Path> finish(std::span<const GeometricPath> paths, std::span<const Crossing> crossings,
                           const EndState& transmitter, const EndState& receiver, const FacetWorld& world,
                           uint32_t threads = 1) const;

  const PathLimits& limits() const { return limits_; }

 private:
  uint32_t edges_diffract(const GeometricPath& path) const;
  void find_edge_sides(std::vector<GeometricPath>& paths, const FacetWorld& world) const;

  const RadioModel* model_;
  PathLimits limits_;
  FieldModel field_;
  std::optional<ImageTree> tree_;
  std::optional<Midpoints> midpoints_;  ///< empty if neither diffraction nor scattering is on
};

}  // namespace greatx::rf
