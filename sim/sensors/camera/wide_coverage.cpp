// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "sim/sensors/camera/wide_coverage.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

namespace greatx::sim {

namespace {

constexpr double unbounded = std::numeric_limits<double>::infinity();
/// Samples along an edge are at most this many pixels apart.
constexpr double sample_pixels = 4.0;

/// The planes of the cube's faces: axis 0 to 2, and the sign.
struct CubeFace {
  int axis;
  double sign;
};
constexpr CubeFace cube_faces[] = {{2, 1.0}, {2, -1.0}, {0, 1.0}, {0, -1.0}, {1, 1.0}, {1, -1.0}};

size_t cube_face_of(const dvec3& p) {
  size_t found = 0;
  double most = -unbounded;
  for (size_t i = 0; i < std::size(cube_faces); ++i)
    if (const double depth = cube_faces[i].sign * p[cube_faces[i].axis]; depth > most) {
      most = depth;
      found = i;
    }
  return found;
}

/// Keeps the part of a convex polygon where `height` is not negative.
template <typename Height>
std::vector<dvec3> clipped(const std::vector<dvec3>& polygon, const Height& height) {
  std::vector<dvec3> kept;
  for (size_t i = 0; i < polygon.size(); ++i) {
    const dvec3 &a = polygon[i], &b = polygon[(i + 1) % polygon.size()];
    const double at_a = height(a), at_b = height(b);
    if (at_a >= 0.0) kept.push_back(a);
    if ((at_a >= 0.0) != (at_b >= 0.0)) kept.push_back(a + (b - a) * (at_a / (at_a - at_b)));
  }
  return kept;
}

/// Returns whether a direction passes a convex polygon that the eye sees within one face of the cube.
bool looks_at(std::span<const dvec3> part, const dvec3& direction) {
  int positive = 0, negative = 0;
  dvec3 middle(0.0);
  for (size_t i = 0; i < part.size(); ++i) {
    const double side = glm::dot(direction, glm::cross(part[i], part[(i + 1) % part.size()]));
    positive += side > 0.0 ? 1 : 0;
    negative += side < 0.0 ? 1 : 0;
    middle += part[i];
  }
  return (positive == 0 || negative == 0) && positive + negative > 0 && glm::dot(direction, middle) > 0.0;
}

}  // namespace

WideProjection::WideProjection(const render::CameraDesc& desc)
    : lens_(render::lens_geometry(desc)), near_m_(desc.near_m), directions_(lens_.centers()) {
  const render::WideLens& wide = desc.wide;
  double most = 1.0;
  if (wide.fisheye()) {
    const double end = std::min(wide.half_angle, wide.fold_angle());
    for (int i = 1; i <= 256; ++i) {
      const double angle = end * i / 256.0;
      most = std::max({most, wide.slope(angle), wide.shown(angle) / std::sin(angle)});
    }
    const double inside = end * (1.0 - 1e-12);
    for (const dvec2& way : {dvec2(1, 0), dvec2(-1, 0), dvec2(0, 1), dvec2(0, -1)})
      rim_.emplace_back(way * std::sin(inside), std::cos(inside));
  }
  pixels_per_radian_ = most * std::max(desc.fx, desc.fy);
}

struct WideProjection::Bounds {
  dvec4 sides{unbounded, unbounded, -unbounded, -unbounded};
  void add(const dvec2& p) {
    sides = {std::min(sides.x, p.x), std::min(sides.y, p.y), std::max(sides.z, p.x), std::max(sides.w, p.y)};
  }
};

/// Adds a straight edge, sampled by its angle as the eye sees it.
void WideProjection::add_edge(const dvec3& from, const dvec3& to, Bounds& bounds) const {
  const bool panorama = !lens_.geometry().wide.fisheye();
  const dvec3 a = glm::normalize(from), b = glm::normalize(to);
  const double angle = std::atan2(glm::length(glm::cross(a, b)), glm::dot(a, b));
  // Near a pole of the panorama the azimuth turns faster.
  double turn = angle;
  if (panorama) turn = std::max(turn, std::abs(std::atan2(a.x * b.z - a.z * b.x, a.x * b.x + a.z * b.z)));
  const double steps = std::clamp(std::ceil(turn * pixels_per_radian_ / sample_pixels), 1.0, 4096.0);
  const auto direction = [&](double s) {
    return angle < 1e-9 ? a + (b - a) * s : a * std::sin((1.0 - s) * angle) + b * std::sin(s * angle);
  };
  const auto place = [&](double s) { return lens_.pixel(direction(s)); };
  std::optional<dvec2> before, here = place(0.0);
  if (here) bounds.add(*here);
  for (double i = 1.0; i <= steps; i += 1.0) {
    const std::optional<dvec2> next = place(i / steps);
    if (next) bounds.add(*next);
    if (here && next && panorama && std::abs(next->x - here->x) > 0.5 * lens_.geometry().width) {
      bounds.add({0.0, next->y});  // across the back, where the rims of the panorama meet
      bounds.add({lens_.geometry().width, next->y});
    } else if (here.has_value() != next.has_value()) {  // the rim of the image circle
      double inside = (here ? i - 1.0 : i) / steps, outside = (here ? i : i - 1.0) / steps;
      for (int half = 0; half < 40; ++half) {
        const double middle = 0.5 * (inside + outside);
        (place(middle) ? inside : outside) = middle;
      }
      if (const std::optional<dvec2> rim = place(inside)) bounds.add(*rim);
    } else if (before && here && next) {
      // A coordinate has an extremum here: add the vertex of the parabola through three points.
      for (int axis = 0; axis < 2; ++axis)
        if (const double rise = (*here)[axis] - (*before)[axis], fall = (*next)[axis] - (*here)[axis];
            rise * fall < 0.0)
          if (const auto vertex = place((i - 1.0 + 0.5 * (rise + fall) / (rise - fall)) / steps))
            bounds.add(*vertex);
    }
    before = here;
    here = next;
  }
}

/// Adds the points within a part where a coordinate of the picture has an extremum: the ends of the image
/// circle, and the poles of a panorama.
void WideProjection::add_special_points(std::span<const dvec3> part, Bounds& bounds) const {
  for (const dvec3& rim : rim_)
    if (looks_at(part, rim))
      if (const std::optional<dvec2> at = lens_.pixel(rim)) bounds.add(*at);
  if (lens_.geometry().wide.fisheye()) return;
  for (const double down : {-1.0, 1.0}) {
    if (!looks_at(part, {0.0, down, 0.0})) continue;
    const double v = down > 0.0 ? lens_.geometry().height : 0.0;
    bounds.add({0.0, v});
    bounds.add({lens_.geometry().width, v});
  }
}

void WideProjection::add_part(std::span<const dvec3> part, Shape& shape, Coverage& coverage) const {
  Bounds bounds;
  for (size_t i = 0; i < part.size(); ++i) add_edge(part[i], part[(i + 1) % part.size()], bounds);
  add_special_points(part, bounds);
  const dvec4& sides = bounds.sides;
  if (!(sides.x <= sides.z)) return;
  shape.bounds = {std::min(shape.bounds.x, sides.x), std::min(shape.bounds.y, sides.y),
                  std::max(shape.bounds.z, sides.z), std::max(shape.bounds.w, sides.w)};
  constexpr double margin = 1.0;  // the error of bounds is a small part of a pixel
  const uint32_t width = lens_.geometry().width, height = lens_.geometry().height;
  const auto within = [](double x, uint32_t end) {
    return static_cast<uint32_t>(std::clamp(std::ceil(x - 0.5), 0.0, static_cast<double>(end)));
  };
  const uint32_t end_row = within(sides.w + margin, height), end_column = within(sides.z + margin, width);
  for (uint32_t row = within(sides.y - margin, height); row < end_row; ++row)
    for (uint32_t column = within(sides.x - margin, width); column < end_column; ++column) {
      const dvec3& direction = directions_[size_t{row} * width + column];
      if (direction != dvec3(0.0) && looks_at(part, direction)) coverage.add(column, row);
    }
}

void WideProjection::add(const std::array<dvec3, 3>& corners, Shape& shape, Coverage& coverage) const {
  const size_t first = cube_face_of(corners[0]);
  const bool one_face = first == cube_face_of(corners[1]) && first == cube_face_of(corners[2]);
  for (size_t i = 0; i < std::size(cube_faces); ++i) {
    if (one_face && i != first) continue;
    const auto [axis, sign] = cube_faces[i];
    const auto depth = [axis = axis, sign = sign](const dvec3& p) { return sign * p[axis]; };
    std::vector<dvec3> part(corners.begin(), corners.end());
    for (const int across : {(axis + 1) % 3, (axis + 2) % 3})
      for (const double side : {1.0, -1.0})
        part = clipped(part, [&](const dvec3& p) { return depth(p) - side * p[across]; });
    if (std::ranges::any_of(part, [&](const dvec3& p) { return depth(p) < near_m_; })) {
      shape.crosses_near = true;
      part = clipped(part, [&](const dvec3& p) { return depth(p) - near_m_; });
    }
    if (part.size() >= 3) add_part(part, shape, coverage);
  }
}

}  // namespace greatx::sim
