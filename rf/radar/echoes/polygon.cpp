// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "rf/radar/echoes/polygon.h"

#include <algorithm>

#include "core/error.h"

namespace greatx::rf {
void Polygon::push(const dvec2& p) {
  if (count_ > 0 && points_[count_ - 1] == p) return;
  if (count_ == capacity) {
    uint32_t shortest = 0;
    double least = 1e300;
    for (uint32_t i = 0; i + 1 < count_; ++i) {
      const dvec2 side = points_[i + 1] - points_[i];
      if (glm::dot(side, side) < least) least = glm::dot(side, side), shortest = i;
    }
    std::copy(points_.begin() + shortest + 1, points_.begin() + count_, points_.begin() + shortest);
    --count_;
  }
  points_[count_++] = p;
}

Polygon::Polygon(std::span<const dvec2> points) {
  GREATX_CHECK(points.size() <= capacity, "{} corners", points.size());
  for (const dvec2& p : points) push(p);
  while (count_ > 1 && points_[0] == points_[count_ - 1]) --count_;
  double twice = 0.0;
  for (uint32_t i = 1; i + 1 < count_; ++i)
    twice += cross(points_[i] - points_[0], points_[i + 1] - points_[0]);
  if (twice < 0.0) std::reverse(points_.begin(), points_.begin() + count_);
}

double Polygon::area() const {
  double twice = 0.0;
  for (uint32_t i = 1; i + 1 < count_; ++i)
    twice += cross(points_[i] - points_[0], points_[i + 1] - points_[0]);
  return 0.5 * twice;
}

dvec2 Polygon::centroid() const {
  double twice = 0.0;
  dvec2 sum(0.0), mean(0.0);
  for (uint32_t i = 1; i + 1 < count_; ++i) {
    const dvec2 a = points_[i] - points_[0], b = points_[i + 1] - points_[0];
    const double area = cross(a, b);
    twice += area;
    sum += area * (a + b);
  }
  if (twice > 0.0) return points_[0] + sum / (3.0 * twice);
  for (uint32_t i = 0; i < count_; ++i) mean += points_[i];
  return mean / std::max(1.0, double(count_));
}

HalfPlane Polygon::inside(uint32_t i) const {
  const dvec2 side = next(i) - points_[i];
  const dvec2 normal(-side.y, side.x);
  return {normal, -glm::dot(normal, points_[i])};
}

Polygon Polygon::clipped(const HalfPlane& side) const {
  Polygon kept;
  for (uint32_t i = 0; i < count_; ++i) {
    const dvec2& a = points_[i];
    const dvec2& b = next(i);
    const double at_a = side.at(a), at_b = side.at(b);
    if (at_a >= 0.0) kept.push(a);
    if ((at_a > 0.0 && at_b < 0.0) || (at_a < 0.0 && at_b > 0.0))
      kept.push(a + (b - a) * (at_a / (at_a - at_b)));
  }
  while (kept.count_ > 1 && kept.points_[0] == kept.points_[kept.count_ - 1]) --kept.count_;
  if (kept.count_ < 3) kept.count_ = 0;
  return kept;
}

}  // namespace greatx::rf
