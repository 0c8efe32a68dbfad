// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "renderer/lens/lens_rays.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/error.h"

namespace greatx::render {

double WideLens::shown(double angle) const {
  const double s = angle * angle;
  return angle * (1.0 + s * (k1 + s * (k2 + s * (k3 + s * k4))));
}

double WideLens::slope(double angle) const {
  const double s = angle * angle;
  return 1.0 + s * (3.0 * k1 + s * (5.0 * k2 + s * (7.0 * k3 + s * 9.0 * k4)));
}

double WideLens::fold_angle() const {
  constexpr int steps = 4096;
  for (int i = 1; i <= steps; ++i) {
    double low = pi * (i - 1) / steps, high = pi * i / steps;
    if (slope(high) > 0.0) continue;
    for (int half = 0; half < 60; ++half) {
      const double middle = 0.5 * (low + high);
      (slope(middle) > 0.0 ? low : high) = middle;
    }
    return low;
  }
  return pi;
}

double WideLens::angle_below(double distance, double fold) const {
  if (!(distance <= shown(fold))) return std::numeric_limits<double>::quiet_NaN();
  // Newton's iteration within brackets: shown() grows from 0 to the fold.
  double low = 0.0, high = fold, t = std::min(distance, fold);
  for (int i = 0; i < 100; ++i) {
    const double residual = shown(t) - distance;
    (residual < 0.0 ? low : high) = t;
    double next = t - residual / slope(t);
    if (!(next >= low && next <= high)) next = 0.5 * (low + high);
    if (std::abs(next - t) <= 1e-15 * (1.0 + t)) return next;
    t = next;
  }
  return t;
}

double WideLens::angle(double distance) const { return angle_below(distance, fold_angle()); }

LensRays::LensRays(const LensGeometry& geometry) : geometry_(geometry) {
  const LensGeometry& g = geometry_;
  switch (g.wide.model) {
    case LensModel::pinhole:
      lens_.emplace(geometry);
      return;
    case LensModel::fisheye:
      fold_ = g.wide.fold_angle();
      check_fisheye();
      return;
    case LensModel::equirectangular:
      if (g.width != 2 * g.height)
        throw_user_error("camera {}: lens: expected a picture twice as wide as high, found {} x {}", g.name,
                         g.width, g.height);
  }
}

void LensRays::check_fisheye() const {
  const LensGeometry& g = geometry_;
  if (fold_ >= g.wide.half_angle) return;
  const double holds = g.wide.shown(fold_);
  if (g.wide.circle_given)
    throw_user_error(
        "camera {}: lens: expected a model that grows up to the image circle of {:.6g} degrees, found one "
        "that holds up to {:.6g} degrees ({:.4g} pixels from the principal point)",
        g.name, degrees(2.0 * g.wide.half_angle), degrees(2.0 * fold_), holds * std::sqrt(g.fx * g.fy));
  for (const dvec2& corner :
       {dvec2(0.0), dvec2(g.width, 0.0), dvec2(0.0, g.height), dvec2(g.width, g.height)}) {
    const dvec2 at((corner.x - g.cx) / g.fx, (corner.y - g.cy) / g.fy);
    if (glm::length(at) <= holds) continue;
    throw_user_error(
        "camera {}: lens: expected a model that does not fold within the picture, or a narrower circle_deg, "
        "found one that holds up to {:.6g} degrees ({:.4g} pixels from the principal point), while pixel "
        "({:.6g}, {:.6g}) lies {:.4g} pixels from it",
        g.name, degrees(2.0 * fold_), holds * std::sqrt(g.fx * g.fy), corner.x, corner.y,
        glm::length(at) * std::sqrt(g.fx * g.fy));
  }
}

dvec3 LensRays::ray(const dvec2& pixel) const {
  const LensGeometry& g = geometry_;
  if (lens_) return glm::normalize(dvec3(lens_->undistorted(pixel), 1.0));
  const dvec2 at((pixel.x - g.cx) / g.fx, (pixel.y - g.cy) / g.fy);
  if (g.wide.model == LensModel::equirectangular)
    return {std::cos(at.y) * std::sin(at.x), std::sin(at.y), std::cos(at.y) * std::cos(at.x)};
  const double distance = glm::length(at), t = g.wide.angle_below(distance, fold_);
  if (!(t <= g.wide.half_angle)) return dvec3(0.0);
  if (distance == 0.0) return {0.0, 0.0, 1.0};
  return {std::sin(t) * at.x / distance, std::sin(t) * at.y / distance, std::cos(t)};
}

std::optional<dvec2> LensRays::pixel(const dvec3& d) const {
  const LensGeometry& g = geometry_;
  if (lens_) {
    if (!(d.z > 0.0)) return std::nullopt;
    return lens_->pixel({d.x / d.z, d.y / d.z});
  }
  if (g.wide.model == LensModel::equirectangular)
    return dvec2(g.cx + g.fx * std::atan2(d.x, d.z), g.cy + g.fy * std::atan2(d.y, std::hypot(d.x, d.z)));
  const double across = std::hypot(d.x, d.y), t = std::atan2(across, d.z);
  if (!(t <= std::min(g.wide.half_angle, fold_))) return std::nullopt;
  const double scale = across > 0.0 ? g.wide.shown(t) / across : 0.0;
  return dvec2(g.cx + g.fx * scale * d.x, g.cy + g.fy * scale * d.y);
}

std::vector<dvec3> LensRays::centers() const {
  const LensGeometry& g = geometry_;
  std::vector<dvec3> rays;
  rays.reserve(size_t{g.width} * g.height);
  if (lens_) {
    for (const dvec2& at : lens_->centers()) rays.push_back(glm::normalize(dvec3(at, 1.0)));
    return rays;
  }
  for (uint32_t row = 0; row < g.height; ++row)
    for (uint32_t column = 0; column < g.width; ++column) rays.push_back(ray({column + 0.5, row + 0.5}));
  return rays;
}

double LensRays::density(const dvec3& d) const {
  const LensGeometry& g = geometry_;
  const double focal = std::sqrt(g.fx * g.fy);
  if (!g.wide.fisheye()) return focal;
  const double across = std::hypot(d.x, d.y), t = std::atan2(across, d.z);
  const double around = across > 1e-9 ? g.wide.shown(t) / std::sin(t) : 1.0;
  return focal * std::sqrt(g.wide.slope(t) * around);
}

}  // namespace greatx::render
