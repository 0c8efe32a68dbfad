// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Plan coordinates as whole multiples of 2^-16 m (15 micrometres). Such numbers are exact in double, and in
// float within 256 m of a whole metre, so corners that are equal here are equal in the finished file and on
// the device, whatever object they belong to. Predicates on them are exact.
#pragma once

#include <cmath>
#include <compare>
#include <cstdint>

#include "core/vec.h"

namespace greatx::scene::place {

/// Grid units in a metre.
inline constexpr double grid_per_m = 65536.0;
/// Largest extent of a triangulation: 2^30 units, 16.384 km. Beyond it in_circle() would overflow.
inline constexpr double most_extent_m = 16384.0;

struct GridPoint {
  int64_t x = 0, y = 0;
  auto operator<=>(const GridPoint&) const = default;
};

inline int64_t to_grid(double metres) { return std::llround(metres * grid_per_m); }
inline GridPoint to_grid(const dvec2& p) { return {to_grid(p.x), to_grid(p.y)}; }
inline double to_metres(int64_t units) { return static_cast<double>(units) / grid_per_m; }
inline dvec2 to_metres(const GridPoint& p) { return {to_metres(p.x), to_metres(p.y)}; }
inline double on_grid(double metres) { return to_metres(to_grid(metres)); }

/// Returns twice the signed area of the triangle: positive if counter-clockwise. Exact.
inline int64_t orientation(const GridPoint& a, const GridPoint& b, const GridPoint& c) {
  return (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x);
}

/// Returns whether d lies strictly inside the circle through a, b and c (counter-clockwise). Exact.
inline bool in_circle(const GridPoint& a, const GridPoint& b, const GridPoint& c, const GridPoint& d) {
  __extension__ using Wide = __int128;
  const int64_t ax = a.x - d.x, ay = a.y - d.y, bx = b.x - d.x, by = b.y - d.y, cx = c.x - d.x,
                cy = c.y - d.y;
  const Wide bc = Wide(bx) * cy - Wide(by) * cx, ca = Wide(cx) * ay - Wide(cy) * ax,
             ab = Wide(ax) * by - Wide(ay) * bx;
  const Wide a2 = Wide(ax) * ax + Wide(ay) * ay, b2 = Wide(bx) * bx + Wide(by) * by,
             c2 = Wide(cx) * cx + Wide(cy) * cy;
  return a2 * bc + b2 * ca + c2 * ab > 0;
}

}  // namespace greatx::scene::place
