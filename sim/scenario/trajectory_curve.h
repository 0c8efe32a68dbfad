// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Defines the one curve behind every moving trajectory: cubic Bezier segments, each over its own span of
// time.
#pragma once

#include <array>
#include <mutex>
#include <optional>
#include <vector>

#include "sim/scenario/trajectory.h"

namespace greatx::sim {

/// Describes a segment: B(u) is the sum of Bernstein polynomials times P0..P3, u = (t - begin) / duration.
/// The control points are held as P0 and the edges P1 - P0, P2 - P1, P3 - P2, so that derivatives do not
/// suffer from large coordinates.
struct CurveSegment {
  double begin_s = 0.0;
  double duration_s = 0.0;  ///< 0: a curve of a single instant, at rest at P0
  dvec3 origin{0.0};
  std::array<dvec3, 3> edges{};

  static CurveSegment bezier(double begin_s, double duration_s, const std::array<dvec3, 4>& points);
  static CurveSegment line(double begin_s, double duration_s, const dvec3& from, const dvec3& to);
  /// Makes a cubic Hermite segment from positions and velocities (m/s) at both ends.
  static CurveSegment hermite(double begin_s, double duration_s, const dvec3& from,
                              const dvec3& from_velocity, const dvec3& to, const dvec3& to_velocity);
  dvec3 position(double u) const;
  dvec3 first(double u) const;   ///< dB/du
  dvec3 second(double u) const;  ///< d2B/du2
  dvec3 third() const;           ///< d3B/du3
};

/// Names the motion before the first and after the last instant.
enum class Beyond {
  hold,      ///< rests at the end, velocity zero
  straight,  ///< goes on with the end's velocity (a sweep that outlasts the last tick keeps its motion)
};

/// A chain of segments without gaps in time.
///
/// The attitude is a slerp between `attitudes` (one per knot) if they are given. Otherwise x looks along the
/// velocity: yaw = atan2(v_y, v_x), pitch = -atan2(v_z, |v_xy|), roll = 0. Where the velocity vanishes, the
/// lowest derivative that does not vanish gives the direction, as seen from before (at the very start from
/// after). In vertical flight the yaw keeps its earlier value; if there is none, it takes the next value,
/// else 0. A segment that does not move keeps the attitude in the same way. The angular velocity is analytic.
/// It is constant per segment for slerp, and otherwise follows from d(yaw)/dt and d(pitch)/dt. It is zero
/// where the yaw is kept and beyond the ends of the curve.
class CurveCourse : public Course {
 public:
  /// Needs one segment or more; `attitudes` is empty or has segments + 1 elements.
  CurveCourse(std::vector<CurveSegment> segments, std::vector<dquat> attitudes, Beyond beyond);
  Motion at(double time_s) const override;
  bool is_static() const override { return static_; }
  double most_speed() const override;
  /// Lengths of segments are integrated by Gauss-Legendre quadrature of eight points on quarters.
  Travel travel(double time_s) const override;

 private:
  struct Heading {
    std::optional<double> yaw, pitch;
    double yaw_rate = 0.0, pitch_rate = 0.0;  ///< per unit of u
  };
  Heading heading(size_t segment, double u) const;
  Motion inside(size_t segment, double time_s) const;
  void orient(size_t segment, double u, Motion& motion) const;
  void find_held_headings();
  double length(size_t segment, double u) const;  ///< from the segment's begin, m
  double length_before(double time_s) const;      ///< from the curve's begin, m

  std::vector<CurveSegment> segments_;
  std::vector<dquat> attitudes_;
  std::vector<Heading> held_;  ///< per segment: the heading where the segment itself gives no direction
  Beyond beyond_;
  bool static_ = false;
  mutable std::once_flag measured_;
  mutable std::vector<double> begins_m_;  ///< [segments] length of the curve before each
};

}  // namespace greatx::sim
