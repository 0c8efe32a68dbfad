// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Describes how a target of a channel scatters a wave, as a point at its centre (docs/targets.md). Such a
// target joins two legs, each of which is a path of the environment:
//
//   transmitter ─► leg (PathSolver) ─► target: ScatterMatrix ─► leg (PathSolver, reversed) ─► receiver
//                                                  │
//                              echo_path(): one Path of type InteractionType::target
//
// H, taps, statistics and files treat the echo like any other path.
#pragma once

#include <array>
#include <cstdint>
#include <limits>

#include "core/vec.h"
#include "rf/antenna/spherical.h"

namespace greatx::rf {

/// Holds the matrix S, m, of a far field: E_s = S E_i e^{-jkr}/r. Rows are the scattered field in (theta,
/// phi) at the direction to the receiver, columns the incident field in (theta, phi) at the direction to the
/// source: [theta theta, theta phi, phi theta, phi phi]. 4 pi |S|^2 is the radar cross-section, m^2. Both
/// directions point away from the target, so that a reciprocal target that sends back has S = S^T.
using ScatterMatrix = std::array<Complex, 4>;

ScatterMatrix transposed(const ScatterMatrix& s);

inline constexpr double far_away = std::numeric_limits<double>::infinity();

/// Holds the directions of an echo, unit vectors that point away from the target, and the distances to the
/// points that the waves are spheres about: the ends, or their images. Infinite: a plane wave.
struct Aspect {
  dvec3 to_source{1.0, 0.0, 0.0}, to_receiver{1.0, 0.0, 0.0};
  double source_m = far_away, receiver_m = far_away;
  /// Returns the bistatic angle between both directions, rad, in [0, pi].
  double bistatic_angle() const;
  /// Returns the unit vector halfway between both directions; the direction to the source if they are
  /// opposite.
  dvec3 bisector() const;
};

/// Identifies the two legs of an echo for random draws. The number of a leg depends on its end and on its
/// interactions alone.
struct EchoKey {
  uint64_t out = 0, home = 0;
  uint32_t sequence = 0;
};

class TargetModel {
 public:
  virtual ~TargetModel() = default;
  /// Returns the matrix for directions in the target's frame (x forward, z up), on the basis of that frame.
  virtual ScatterMatrix scatter(const Aspect& aspect, const EchoKey& key) const = 0;
};

/// Returns the matrix on the bases of the world for a target that `orientation` (world_from_target) turns.
/// `aspect` has world directions.
ScatterMatrix scatter_in_world(const TargetModel& model, const dquat& orientation, const Aspect& aspect,
                               const EchoKey& key);

}  // namespace greatx::rf
