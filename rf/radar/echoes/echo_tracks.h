// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Computes the delay of an echo over time while bodies and ends move. The vertices of a path keep their
// places on their bodies.
//
// A reflection vertex is where the path is shortest. By Fermat's principle, the gliding of the true vertex
// therefore changes the delay in second order only: with a speed v across the path at a distance R, the error
// of the path length is at most (v t)^2 / R after t seconds.
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

/// A point that moves with a body. Body 0 stands for local coordinates at rest.
struct CarriedPoint {
  uint32_t body = 0;
  dvec3 at{0.0};  ///< in the frame of the body
};

/// Holds the vertices of one path.
struct CarriedPath {
  std::array<CarriedPoint, most_surfaces> points;
  uint32_t count = 0;
  operator std::span<const CarriedPoint>() const { return std::span(points).first(count); }
};

/// Holds the poses of bodies and ends at a list of times, which the constructor asks for once. Reading is
/// thread-safe.
class PoseTable {
 public:
  /// `bodies` [bodies of the scene] tells which poses may be asked for. Uses `threads` threads.
  PoseTable(const EchoMotion& motion, std::span<const bool> bodies, std::vector<double> times_s,
            uint32_t threads);
  const std::vector<double>& times_s() const { return times_s_; }
  const Pose& body(uint32_t body, size_t time) const { return bodies_[body][time]; }
  const dvec3& transmitter(size_t time) const { return transmitter_[time]; }
  const dvec3& receiver(size_t time) const { return receiver_[time]; }
  /// Returns the length of the path transmitter - vertices - receiver, metres.
  double length(std::span<const CarriedPoint> vertices, size_t time) const;

 private:
  std::vector<double> times_s_;
  std::vector<std::vector<Pose>> bodies_;  ///< [bodies][times]; empty for a body that was not asked for
  std::vector<dvec3> transmitter_, receiver_;
};

/// Returns the times at which a track is fitted, followed by those at which the fit is checked.
std::vector<double> track_times(const EchoMotion& motion);

/// Fits a cubic through four of track_times(). Returns false if the path length at one of the check times
/// differs from the cubic by more than `tolerance_m`.
bool fit_track(const PoseTable& poses, std::span<const CarriedPoint> vertices, double tolerance_m,
               DelayTrack& track);

/// Returns the delay and its rate at the start of each slot. `poses` holds the slot starts, followed by the
/// times `step_s` after each of them.
std::vector<std::array<double, 2>> track_table(const PoseTable& poses, std::span<const CarriedPoint> vertices,
                                               double step_s);

/// Returns the vertices of a path of reflections in the frames of their bodies. The path starts at the
/// transmitter along `departure` and runs over the facets of `chain`. The last vertex is `point`.
CarriedPath carried_vertices(const FacetWorld& world, const dvec3& transmitter, const dvec3& departure,
                             std::span<const uint32_t> chain, const dvec3& point);

}  // namespace greatx::rf
