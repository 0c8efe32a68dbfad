// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// From candidates to fields for the links of one source (a transmitter, or a receiver that stands still) to
// any number of targets, in three steps around the GPU's answer to what stands in the way:
//
//   geometry(target) ─► add_segments() ─► CrossingPass ─► finish()
//
// Each step reads the solver and writes nothing to it: targets may be solved side by side, and a target's
// paths depend on that target alone.
#pragma once

#include <cstdint>
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

/// An end of a link at a tick: local coordinates, local axes.
struct EndState {
  dvec3 position{0.0}, velocity{0.0};
  dquat orientation{1.0, 0.0, 0.0, 0.0};
  uint32_t body = 0;  ///< that carries it and does not hide it; 0: none
};

/// A link's paths before the GPU has answered.
struct LinkGeometry {
  std::vector<GeometricPath> paths;  ///< canonical order; reflections, diffraction, scattering, no walls yet
  uint64_t overflow = 0;             ///< paths beyond PathLimits::max_paths
  LeftOut searched = {};             ///< of the search at the target
};

/// Takes what is beyond `most` paths (in canonical order, before and after) off a link, and counts it:
/// scattering first, then diffraction, the longest chains before others.
void keep_most(LinkGeometry& link, uint64_t most);

class PathSolver {
 public:
  /// `model` is read by every call and must outlive the solver. `moving_bodies`: facets of bodies other than
  /// 0 reflect.
  PathSolver(const RadioModel& model, const PathLimits& limits, bool moving_bodies = false);

  /// Builds the images of `source` for these candidates, which run from it.
  void set_candidates(const CandidateList& candidates, const dvec3& source, Source end);
  /// The source has moved, or bodies of the model have; candidates stay, their windows do not.
  void move_source(const dvec3& source);

  /// Every chain that exists geometrically between the source and `target`.
  LinkGeometry geometry(const EndState& target) const;
  /// Appends the segments of the paths, one after the other.
  void add_segments(std::span<const GeometricPath> paths, const EndState& transmitter,
                    const EndState& receiver, std::vector<Segment>& segments) const;
  /// Walls become interactions; blocked paths and those beyond the bounds go; fields of the rest, in
  /// canonical order. `crossings`: the answers to the segments of these paths. `world`: a copy of the model's
  /// facets as they stood when the geometry was solved; those of the model may have moved on since.
  std::vector<Path> finish(std::span<const GeometricPath> paths, std::span<const Crossing> crossings,
                           const EndState& transmitter, const EndState& receiver,
                           const FacetWorld& world) const;

  const PathLimits& limits() const { return limits_; }

 private:
  uint32_t walls_allowed(const GeometricPath& path) const;

  const RadioModel* model_;
  PathLimits limits_;
  FieldModel field_;
  std::optional<ImageTree> tree_;
  std::optional<Midpoints> midpoints_;  ///< none: neither diffraction nor scattering
};

}  // namespace greatx::rf
