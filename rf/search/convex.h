// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Cuts convex polygons in the plane of slopes by half-planes.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>

#include "core/vec.h"

namespace greatx::rf {

struct SlopeRect {
  double min_a = 0.0, max_a = 0.0, min_b = 0.0, max_b = 0.0;
  void add(const dvec2& x) {
    min_a = std::min(min_a, x.x), max_a = std::max(max_a, x.x);
    min_b = std::min(min_b, x.y), max_b = std::max(max_b, x.y);
  }
  void add(const SlopeRect& other) {
    min_a = std::min(min_a, other.min_a), max_a = std::max(max_a, other.max_a);
    min_b = std::min(min_b, other.min_b), max_b = std::max(max_b, other.max_b);
  }
  bool overlaps(const SlopeRect& other) const {
    return min_a <= other.max_a && other.min_a <= max_a && min_b <= other.max_b && other.min_b <= max_b;
  }
  static SlopeRect none() { return {1e300, -1e300, 1e300, -1e300}; }
};

/// Describes the half-plane a x + b y + c >= 0.
struct HalfPlane {
  double a = 0.0, b = 0.0, c = 1.0;
  double at(const dvec2& x) const { return a * x.x + b * x.y + c; }
  /// most() and least() return the largest and the least value on a rectangle.
  double most(const SlopeRect& rect) const {
    return std::max(a * rect.min_a, a * rect.max_a) + std::max(b * rect.min_b, b * rect.max_b) + c;
  }
  double least(const SlopeRect& rect) const {
    return std::min(a * rect.min_a, a * rect.max_a) + std::min(b * rect.min_b, b * rect.max_b) + c;
  }
};

struct Convex {
  static constexpr uint32_t capacity = 24;
  uint32_t count = 0;
  std::array<dvec2, capacity> at;

  Convex() = default;
  Convex(const Convex& other) { *this = other; }
  Convex& operator=(const Convex& other) {  // copies only the corners in use
    count = other.count;
    std::copy_n(other.at.begin(), count, at.begin());
    return *this;
  }
  bool add(const dvec2& x) {
    if (count == capacity) return false;
    at[count++] = x;
    return true;
  }
  SlopeRect box() const {
    SlopeRect box = SlopeRect::none();
    for (uint32_t i = 0; i < count; ++i) box.add(at[i]);
    return box;
  }
};

/// Keeps the part inside. Returns false if nothing is left. A polygon without room for more corners stays
/// unchanged.
bool clip(Convex& shape, const HalfPlane& half);
/// Splits a polygon into both sides, one of which may be empty. Returns false and does nothing if there is no
/// room for more corners.
bool split(const Convex& shape, const HalfPlane& half, Convex& inside, Convex& outside);

}  // namespace greatx::rf
