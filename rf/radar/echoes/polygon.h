// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Provides small convex polygons in a plane, with counter-clockwise corners, for parts of tubes. They
// allocate no memory.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <span>

#include "core/vec.h"

namespace greatx::rf {

/// Returns the area that turns a towards b: the third component of the cross product.
inline double cross(const dvec2& a, const dvec2& b) { return a.x * b.y - a.y * b.x; }

/// The half-plane x . normal + offset >= 0.
struct HalfPlane {
  dvec2 normal{0.0};
  double offset = 0.0;
  double at(const dvec2& p) const { return glm::dot(normal, p) + offset; }
};

class Polygon {
 public:
  static constexpr uint32_t capacity = 24;

  Polygon() {}  // the corners stay uninitialized, since polygons are made by the million
  Polygon(const Polygon& other) { *this = other; }
  Polygon& operator=(const Polygon& other) {
    std::copy_n(other.points_.begin(), other.count_, points_.begin());
    count_ = other.count_;
    return *this;
  }
  /// Takes at most `capacity` points and reverses them if they run clockwise. Repeated points are kept once.
  explicit Polygon(std::span<const dvec2> points);

  uint32_t size() const { return count_; }
  bool empty() const { return count_ < 3; }
  const dvec2& operator[](uint32_t i) const { return points_[i]; }
  const dvec2& next(uint32_t i) const { return points_[i + 1 < count_ ? i + 1 : 0]; }
  double area() const;
  /// Returns the centroid of the area, or the mean of the corners if the area is 0.
  dvec2 centroid() const;
  /// Returns the part in a half-plane. A polygon that would exceed `capacity` loses its shortest side, which
  /// changes its area by less than a tube resolves.
  Polygon clipped(const HalfPlane& side) const;
  /// Returns the half-plane on the inner side of side i.
  HalfPlane inside(uint32_t i) const;

 private:
  void push(const dvec2& p);
  std::array<dvec2, capacity> points_;
  uint32_t count_ = 0;
};

}  // namespace greatx::rf
