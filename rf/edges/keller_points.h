// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Finds the points on two edges over which a path runs, and bounds the field that it can carry.
#pragma once

#include <optional>

#include "rf/edges/diffraction.h"

namespace greatx::rf {

/// Two planes, or a ray and a plane, that differ by less than this count as one: corners in a file stand off
/// the planes of their facets.
inline constexpr double coplanar_rad = 2e-3, coplanar_m = 2e-3, parallel_rad = 0.035;

/// The points of two edges over which the path from `before` to `after` is shortest.
struct KellerPoints {
  dvec3 first{0.0}, second{0.0};
};

/// Returns the points for edges in this order, if each lies on its edge (within the tolerance of
/// keller_point()), and if they are at least `least_edge_gap_m` apart. The length is a convex function of
/// both places: the slopes at the ends of the first edge refuse nearly all pairs, regula falsi comes near its
/// least, and Newton's method finds it to its rounding. Ends may be images.
std::optional<KellerPoints> keller_points(const scene::Wedge& first, const scene::Wedge& second,
                                          const dvec3& before, const dvec3& after);
inline constexpr double least_edge_gap_m = 1e-3;

/// Returns a bound of the loss of a path over two edges against free space over its whole length, dB: the
/// loss is at least this, for any materials and polarizations. `before` and `after` may be images of the
/// ends.
double least_two_edge_loss_db(const scene::Wedge& first, const scene::Wedge& second, const dvec3& before,
                              const KellerPoints& points, const dvec3& after, double wave_number);

}  // namespace greatx::rf
