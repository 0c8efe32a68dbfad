// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// How long an echo is under way while everything moves: vertices stay where they are on their bodies.
//
// A reflection's vertex is where the path is shortest, so that letting it glide changes the delay in second
// order only (Fermat): with v across the path at a distance R the error of the path's length is at most (v
// t)^2 / R after t seconds.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "core/vec.h"
#include "rf/config/echo_options.h"
#include "rf/facets/facet_world.h"
#include "rf/radar/echoes/echo_motion.h"
#include "rf/radar/signal/echo.h"

namespace greatx::rf {

/// A point that goes with a body; 0: local coordinates, at rest.
struct CarriedPoint {
  uint32_t body = 0;
  dvec3 at{0.0};  ///< in the body's frame
};

/// The vertices of one path.
struct CarriedPath {
  std::array<CarriedPoint, most_surfaces> points;
  uint32_t count = 0;
  operator std::span<const CarriedPoint>() const { return std::span(points).first(count); }
};

/// Where bodies and ends are at a list of times, asked for once. Thread-safe afterwards.
class PoseTable {
 public:
  /// `bodies` [of the scene]: whether it may be asked for.
  PoseTable(const EchoMotion& motion, std::span<const bool> bodies, std::vector<double> times_s);
  const std::vector<double>& times_s() const { return times_s_; }
  const Pose& body(uint32_t body, size_t time) const { return bodies_[body][time]; }
  const dvec3& transmitter(size_t time) const { return transmitter_[time]; }
  const dvec3& receiver(size_t time) const { return receiver_[time]; }
  /// Length of transmitter - vertices - receiver, metres.
  double length(std::span<const CarriedPoint> vertices, size_t time) const;

 private:
  std::vector<double> times_s_;
  std::vector<std::vector<Pose>> bodies_;  ///< [bodies][times], empty where not asked for
  std::vector<dvec3> transmitter_, receiver_;
};

/// Times that a track is made from and held against.
std::vector<double> track_times(const EchoMotion& motion);

/// A cubic through four of track_times() if all of them lie within `tolerance_m` of it.
bool fit_track(const PoseTable& poses, std::span<const CarriedPoint> vertices, double tolerance_m,
               DelayTrack& track);

/// Delay and its rate at every slot's start: `poses` at slot starts, then a short time after each.
std::vector<std::array<double, 2>> track_table(const PoseTable& poses, std::span<const CarriedPoint> vertices,
                                               double step_s);

/// Where a path of reflections runs: from the transmitter along `departure` over the facets of `chain`, in
/// the frames of their bodies. The last vertex is `point`.
CarriedPath carried_vertices(const FacetWorld& world, const dvec3& transmitter, const dvec3& departure,
                             std::span<const uint32_t> chain, const dvec3& point);

}  // namespace greatx::rf
