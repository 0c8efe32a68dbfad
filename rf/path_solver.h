// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// All stages from candidates to fields for the links of one source (a transmitter, or a receiver that stands still) to
// any number of targets (rf/path.h draws them). One solver per source.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "rf/candidate_search.h"
#include "rf/crossings.h"
#include "rf/geometry.h"
#include "rf/path.h"
#include "rf/radio_model.h"
#include "rf/search/beam_search.h"

namespace greatx::rf {

/// An end of a link at a tick: local coordinates, local axes.
struct EndState {
  dvec3 position{0.0}, velocity{0.0};
  dquat orientation{1.0, 0.0, 0.0, 0.0};
  uint32_t body = 0;  ///< that carries it and does not hide it; 0: none
};

struct PathOptions {
  uint32_t max_depth = 3;          ///< interactions on a path, of whatever type
  uint32_t max_transmissions = 3;  ///< walls passed, if transmission is on
  uint32_t max_suffix = 0;       ///< reflections after a diffraction or scattering (searched at every target)
  double patch_m = 5.0;          ///< largest side of a scattering patch
  uint64_t max_paths = 100'000;  ///< per link: beyond, the weakest candidates are left out and counted
};

/// A link's paths, or what is known of them before the GPU has answered.
class PathSolver {
 public:
  PathSolver(const RadioModel& model, const PathOptions& options);

  /// Builds the images of `source` for these candidates (from the source's end).
  void set_candidates(const CandidateList& candidates, const dvec3& source, Source end);
  /// The source has moved; candidates are kept (their windows are not).
  void move_source(const dvec3& source);

  /// Exact geometry of one link: every chain that exists, walls and occlusion not yet looked at. Thread-safe.
  std::vector<GeometricPath> geometry(const dvec3& target) const;
  /// The segments of a link's paths, one after the other, for CrossingPass. `source`, `target`: in the order
  /// transmitter, receiver.
  void add_segments(std::span<const GeometricPath> paths, const EndState& transmitter,
                    const EndState& receiver, std::vector<Segment>& segments) const;
  /// Walls become interactions, dark paths and those beyond max_depth go, fields of the rest. `crossings`: the answers to
  /// add_segments' part. Canonical order.
  std::vector<Path> finish(std::vector<GeometricPath> paths, std::span<const Crossing> crossings,
                           const EndState& transmitter, const EndState& receiver) const;

 private:
  const RadioModel* model_;
  PathOptions options_;
  std::optional<ImageTree> tree_;
};

}  // namespace greatx::rf
