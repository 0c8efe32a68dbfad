// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Estimates what an edge sends, for draws that choose among many edges.
#pragma once

#include <array>

#include "core/vec.h"
#include "scene/description/wedges.h"

namespace greatx::rf {

/// Returns the power that comes from `before` over the point `at` of an edge to `after`, relative to that of
/// free space over the same length: the squares of the terms of UTD (rf/edges/utd.h), without their phases,
/// and with a third of the power for those of the reflections. `before` and `after` are in the exterior. The
/// result is greater than 0.
double edge_share(const scene::Wedge& posed, const dvec3& before, const dvec3& at, const dvec3& after,
                  double wave_number);

/// Describes an edge as a point sees it.
struct EdgeView {
  double foot_m = 0.0;  ///< place on the edge's line, from its start, that is nearest to the point
  double away_m = 0.0;  ///< distance of the point from the line, and from the edge
  double from_edge_m = 0.0;
  double angle = 0.0;  ///< under which the edge is seen, rad
  double first = 0.0;  ///< angle from the foot to the edge's start, rad
};
EdgeView view_of(const scene::Wedge& posed, const dvec3& point);

/// Estimates edge_share() for many points around them at once. Nearly all of the power comes from within a
/// few degrees of the boundaries of shadow and reflection, which are half-planes through the edge.
class BoundaryShare {
 public:
  /// `point` is the end that stays.
  BoundaryShare(const scene::Wedge& posed, const dvec3& point, double wave_number);
  /// Returns the estimate for points within a radius around `center`; it is greater than 0.
  double of(const dvec3& center, double radius_m) const;

 private:
  dvec3 start_{0.0}, tangent_0_{0.0}, normal_0_{0.0};
  std::array<dvec2, 3> boundaries_;  ///< unit directions across the edge: shadow, reflections
  double away_m_ = 0.0, wave_number_ = 0.0;
};

}  // namespace greatx::rf
