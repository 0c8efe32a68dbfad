// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "sim/sensors/camera/coverage.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>

#include "renderer/lens/lens.h"

namespace greatx::sim {

namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();

/// Returns the first of 0 .. end whose centre, at + 0.5, is at or beyond x.
uint32_t first_center(double x, uint32_t end) {
  return static_cast<uint32_t>(std::clamp(std::ceil(x - 0.5), 0.0, static_cast<double>(end)));
}

}  // namespace

Projection::Projection(const render::CameraDesc& desc)
    : width_(desc.width),
      height_(desc.height),
      fx_(desc.fx),
      fy_(desc.fy),
      cx_(desc.cx),
      cy_(desc.cy),
      near_m_(desc.near_m),
      distortion_(desc.distortion),
      fold_radius_(desc.distortion.fold_radius()),
      least_(0.0),
      most_(desc.width, desc.height) {
  if (!distorted()) return;
  const render::Lens lens(render::lens_geometry(desc));
  const dvec2 focal(fx_, fy_), principal(cx_, cy_);
  least_ = principal + focal * lens.bounds().least;
  most_ = principal + focal * lens.bounds().most;
  centers_ = lens.centers(focal, principal);
  seen_radius_ = glm::length(glm::max(glm::abs(lens.bounds().least), glm::abs(lens.bounds().most)));
}

dvec2 Projection::shown(dvec2 direction) const {
  if (const double r = glm::length(direction); r > fold_radius_) direction *= fold_radius_ / r;
  return dvec2(cx_, cy_) + dvec2(fx_, fy_) * distortion_.distort(direction);
}

struct Projection::Bounds {
  dvec4 sides{infinity, infinity, -infinity, -infinity};
  void add(const dvec2& p) {
    sides = {std::min(sides.x, p.x), std::min(sides.y, p.y), std::max(sides.z, p.x), std::max(sides.w, p.y)};
  }
};

/// Adds a straight edge that the lens bends. Positions along the edge are measured from its closest point to
/// the axis, in normalised coordinates.
void Projection::add_edge(const dvec2& from, const dvec2& to, Bounds& bounds) const {
  const dvec2 a = normalised(from), along = normalised(to) - a;
  const double length = glm::length(along), step = edge_step / std::max(fx_, fy_);
  bounds.add(shown(a));
  if (!(length > step)) return;  // the next edge adds the other end
  const dvec2 unit = along / length;
  const double begin = glm::dot(a, unit), end = begin + length;
  const dvec2 closest = a - begin * unit;
  const double distance = glm::length(closest);
  const auto point = [&](double at) { return shown(closest + at * unit); };
  // Outside the visible part, points are evenly spaced by angle: this part is far from the axis, and beyond
  // the fold it maps to an arc.
  const auto add_outside = [&](double first, double last) {
    const double from_angle = std::atan2(first, distance), to_angle = std::atan2(last, distance);
    const double points = std::ceil(std::abs(to_angle - from_angle) * seen_radius_ / step);
    for (double i = 1.0; i < points; i += 1.0)
      bounds.add(point(distance * std::tan(from_angle + (to_angle - from_angle) * (i / points))));
    bounds.add(point(last));
  };
  const double reach =
      distance < seen_radius_ ? std::sqrt(seen_radius_ * seen_radius_ - distance * distance) : 0.0;
  const double first = std::clamp(-reach, begin, end), last = std::clamp(reach, begin, end);
  if (first > begin) add_outside(begin, first);
  const double points = std::max(1.0, std::ceil((last - first) / step)), each = (last - first) / points;
  dvec2 before = point(first), here = point(first + each);
  bounds.add(before);
  bounds.add(here);
  for (double i = 2.0; i <= points; i += 1.0) {
    const dvec2 next = point(first + i * each);
    bounds.add(next);
    // A coordinate has an extremum here: add the vertex of the parabola through three points.
    for (int axis = 0; axis < 2; ++axis)
      if (const double rise = here[axis] - before[axis], fall = next[axis] - here[axis]; rise * fall < 0.0)
        bounds.add(point(first + (i - 1.0 + 0.5 * (rise + fall) / (rise - fall)) * each));
    before = here;
    here = next;
  }
  if (last < end) add_outside(last, end);
}

dvec4 Projection::bounds(std::span<const dvec2> polygon) const {
  Bounds bounds;
  for (size_t i = 0; i < polygon.size(); ++i) {
    if (distorted())
      add_edge(polygon[i], polygon[(i + 1) % polygon.size()], bounds);
    else
      bounds.add(polygon[i]);
  }
  return bounds.sides;
}

Coverage::Coverage(const Projection& projection)
    : projection_(&projection),
      words_((size_t{projection.width()} + 63) / 64),
      bits_(words_ * projection.height(), 0),
      first_row_(projection.height()),
      end_row_(0) {}

void Coverage::clear() {
  if (first_row_ < end_row_)
    std::fill(bits_.begin() + static_cast<ptrdiff_t>(words_ * first_row_),
              bits_.begin() + static_cast<ptrdiff_t>(words_ * end_row_), 0);
  first_row_ = projection_->height();
  end_row_ = 0;
}

uint64_t* Coverage::row_bits(uint32_t row) {
  first_row_ = std::min(first_row_, row);
  end_row_ = std::max(end_row_, row + 1);
  return bits_.data() + words_ * row;
}

uint32_t Coverage::count() const {
  uint32_t total = 0;
  for (size_t i = words_ * first_row_; i < words_ * end_row_; ++i)
    total += static_cast<uint32_t>(std::popcount(bits_[i]));
  return total;
}

void Coverage::add(std::span<const dvec2> polygon, const dvec4& bounds) {
  if (projection_->distorted())
    add_distorted(polygon, bounds);
  else
    add_straight(polygon);
}

void Coverage::add_span(uint32_t row, uint32_t first, uint32_t end) {
  if (first >= end) return;
  uint64_t* const words = row_bits(row);
  const uint32_t last = end - 1;
  const uint64_t from = ~uint64_t{0} << (first % 64), to = ~uint64_t{0} >> (63 - last % 64);
  if (first / 64 == last / 64) {
    words[first / 64] |= from & to;
    return;
  }
  words[first / 64] |= from;
  for (uint32_t i = first / 64 + 1; i < last / 64; ++i) words[i] = ~uint64_t{0};
  words[last / 64] |= to;
}

void Coverage::add_straight(std::span<const dvec2> polygon) {
  double top = infinity, bottom = -infinity;
  for (const dvec2& corner : polygon) {
    top = std::min(top, corner.y);
    bottom = std::max(bottom, corner.y);
  }
  const uint32_t end = first_center(bottom, projection_->height());
  for (uint32_t row = first_center(top, projection_->height()); row < end; ++row) {
    const double y = row + 0.5;
    double left = infinity, right = -infinity;
    for (size_t i = 0; i < polygon.size(); ++i) {
      // Edges go from the upper end to the lower one in either direction of the polygon, so that adjacent
      // polygons find the same crossing.
      const dvec2 *a = &polygon[i], *b = &polygon[(i + 1) % polygon.size()];
      if (a->y > b->y) std::swap(a, b);
      if (!(a->y <= y && y < b->y)) continue;
      const double x = a->x + (y - a->y) * ((b->x - a->x) / (b->y - a->y));
      left = std::min(left, x);
      right = std::max(right, x);
    }
    if (left < right)
      add_span(row, first_center(left, projection_->width()), first_center(right, projection_->width()));
  }
}

void Coverage::add_distorted(std::span<const dvec2> polygon, const dvec4& bounds) {
  constexpr double margin = 1.0;  // the error of bounds is a small part of a pixel
  double doubled_area = 0.0;
  for (size_t i = 0; i < polygon.size(); ++i) {
    const dvec2 a = polygon[i] - polygon[0], b = polygon[(i + 1) % polygon.size()] - polygon[0];
    doubled_area += a.x * b.y - a.y * b.x;
  }
  const dvec4 within = bounds + dvec4(-margin, -margin, margin, margin);
  if (doubled_area == 0.0) return;
  const double side = doubled_area > 0.0 ? 1.0 : -1.0;
  const uint32_t width = projection_->width(), end_row = first_center(within.w, projection_->height()),
                 end_column = first_center(within.z, width);
  for (uint32_t row = first_center(within.y, projection_->height()); row < end_row; ++row) {
    const dvec2* const centers = projection_->centers().data() + size_t{row} * width;
    for (uint32_t column = first_center(within.x, width); column < end_column; ++column) {
      bool inside = true;
      for (size_t i = 0; inside && i < polygon.size(); ++i) {
        const dvec2& a = polygon[i];
        const dvec2 along = polygon[(i + 1) % polygon.size()] - a, to = centers[column] - a;
        inside = side * (along.x * to.y - along.y * to.x) >= 0.0;
      }
      if (inside) add(column, row);
    }
  }
}

}  // namespace greatx::sim
