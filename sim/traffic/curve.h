// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Smooth curves through the points of lanes and walking lines.
#pragma once

#include <optional>
#include <vector>

#include "core/vec.h"

namespace greatx::sim {

/// A place of a curve as seen from above, with derivatives by the length s of the curve seen from above.
struct CurvePlace {
  dvec2 position{0.0}, tangent{1.0, 0.0};        ///< m, unit
  double curvature = 0.0, curvature_rate = 0.0;  ///< 1/m, 1/m^2; to the left is positive
  double height = 0.0, slope = 0.0, slope_rate = 0.0;
  dvec2 left() const { return {-tangent.y, tangent.x}; }
};

/// A cubic spline through points, over their chords: position, direction and curvature are continuous. Two
/// points give a straight line. The parameter is the length as seen from above, which is integrated by
/// Gauss-Legendre quadrature and inverted by Newton's method to about 1e-12 m.
class Curve {
 public:
  /// The directions at both ends are those of the first and the last chord if they are not given.
  explicit Curve(const std::vector<dvec3>& points, std::optional<dvec2> start = std::nullopt,
                 std::optional<dvec2> end = std::nullopt);
  double length() const { return lengths_.back(); }
  /// Returns a place. Before the start and after the end the curve goes straight on.
  CurvePlace at(double s) const;
  double most_curvature() const { return most_curvature_; }
  bool straight() const { return segments_.size() == 1; }
  /// Whether it is level, so that lengths seen from above are lengths.
  bool level() const { return level_; }

 private:
  struct Segment {
    dvec3 c[4];  ///< c0 + c1 u + c2 u^2 + c3 u^3, u in [0, chord]
    double chord = 0.0;
  };
  CurvePlace inside(size_t segment, double u) const;
  double length(size_t segment, double u) const;

  std::vector<Segment> segments_;
  std::vector<double> lengths_;  ///< [segments + 1] from the start
  double most_curvature_ = 0.0;
  bool level_ = true;
};

/// Returns a closed line with its corners cut (Chaikin, An algorithm for high-speed curve generation, 1974)
/// and points at most `step_m` apart. The first point, the middle of the longest edge, is also the last.
std::vector<dvec3> rounded_ring(const std::vector<dvec3>& corners, double step_m);
/// Returns the points moved to the left of their line as seen from above. A closed line stays closed.
std::vector<dvec3> shifted(const std::vector<dvec3>& points, double left_m, bool closed);

}  // namespace greatx::sim
