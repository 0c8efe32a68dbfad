// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "renderer/lens/lens.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include "core/error.h"
#include "core/units.h"

namespace greatx::render {

namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();

/// Returns the distorted radius of a lens without tangential terms.
double radial(const Distortion& d, double r) {
  const double s = r * r;
  return r * (1.0 + s * (d.k1 + s * (d.k2 + s * d.k3)));
}

/// Returns where radial() takes the value `target`, or the fold if that comes first. radial() grows up to
/// there, so bisection finds the place.
double radial_inverse(const Distortion& d, double target) {
  const double fold = d.fold_radius();
  double low = 0.0, high = target;
  while (high < fold && radial(d, high) < target) high *= 2.0;
  high = std::min(high, fold);
  for (int i = 0; i < 30; ++i) {
    const double middle = 0.5 * (low + high);
    (radial(d, middle) < target ? low : high) = middle;
  }
  return 0.5 * (low + high);
}

/// Runs Newton's iteration for distort(u) = `distorted` from `u`. Steps are halved while they do not lead
/// closer. The result is empty if the iteration gets stuck (on a fold).
std::optional<dvec2> newton(const Distortion& d, const dvec2& distorted, dvec2 u) {
  dvec2 residual = d.distort(u) - distorted;
  for (int i = 0; i < 60; ++i) {
    const glm::dmat2 jacobian = d.jacobian(u);
    if (!(glm::determinant(jacobian) > 0.0)) return std::nullopt;
    dvec2 step = glm::inverse(jacobian) * residual;
    const double moved = glm::length(step), error = glm::length(residual);
    if (!(moved > Lens::tolerance * (1.0 + glm::length(u)))) return u - step;
    dvec2 next_residual = d.distort(u - step) - distorted;
    for (int half = 0; half < 40 && !(glm::length(next_residual) < error); ++half) {
      step *= 0.5;
      next_residual = d.distort(u - step) - distorted;
    }
    u -= step;
    residual = next_residual;
  }
  return std::nullopt;
}

/// Returns whether the determinant of the Jacobian is positive all along from the axis to `u`.
bool unfolded(const Distortion& d, const dvec2& u) {
  constexpr int steps = 64;
  for (int i = 1; i <= steps; ++i)
    if (!(glm::determinant(d.jacobian(u * (double(i) / steps))) > 0.0)) return false;
  return true;
}

/// Returns the smallest undistorted radius at which the determinant of the Jacobian is no longer positive,
/// over all directions.
double fold_radius_any_direction(const Distortion& d, double within) {
  double least = within;
  constexpr int directions = 720, steps = 512;
  for (int i = 0; i < directions; ++i) {
    const double angle = 2.0 * pi * i / directions;
    const dvec2 towards(std::cos(angle), std::sin(angle));
    const auto folded = [&](double r) { return !(glm::determinant(d.jacobian(towards * r)) > 0.0); };
    for (int k = 1; k <= steps; ++k) {
      double high = within * k / steps, low = within * (k - 1) / steps;
      if (low >= least) break;
      if (!folded(high)) continue;
      for (int half = 0; half < 40; ++half) {
        const double middle = 0.5 * (low + high);
        (folded(middle) ? high : low) = middle;
      }
      least = std::min(least, low);
      break;
    }
  }
  return least;
}

[[noreturn]] void fail(const LensGeometry& g, const dvec2& pixel, const dvec2& distorted) {
  const Distortion& d = g.distortion;
  const double reach = glm::length(distorted);
  const double fold = fold_radius_any_direction(d, 4.0 * reach + 1.0);
  const double holds = radial(d, fold) * std::sqrt(g.fx * g.fy);
  throw_user_error(
      "camera {}: distortion: expected a model that does not fold within the picture, found one that holds "
      "up to a "
      "radius of {:.4g} ({:.4g} pixels from the principal point), while pixel ({:.6g}, {:.6g}) lies {:.4g} "
      "pixels "
      "from it",
      g.name, fold, holds, pixel.x, pixel.y, reach * std::sqrt(g.fx * g.fy));
}

}  // namespace

dvec2 Distortion::distort(const dvec2& u) const {
  const double s = glm::dot(u, u), scale = 1.0 + s * (k1 + s * (k2 + s * k3));
  return {u.x * scale + 2.0 * p1 * u.x * u.y + p2 * (s + 2.0 * u.x * u.x),
          u.y * scale + p1 * (s + 2.0 * u.y * u.y) + 2.0 * p2 * u.x * u.y};
}

glm::dmat2 Distortion::jacobian(const dvec2& u) const {
  const double s = glm::dot(u, u), scale = 1.0 + s * (k1 + s * (k2 + s * k3));
  const double slope = 2.0 * (k1 + s * (2.0 * k2 + s * 3.0 * k3));  // d scale / d x = slope x
  const double mixed = slope * u.x * u.y + 2.0 * p1 * u.x + 2.0 * p2 * u.y;
  return glm::dmat2(scale + slope * u.x * u.x + 2.0 * p1 * u.y + 6.0 * p2 * u.x, mixed, mixed,
                    scale + slope * u.y * u.y + 6.0 * p1 * u.y + 2.0 * p2 * u.x);
}

double Distortion::fold_radius() const {
  // In s = r^2 the slope is a cubic. Between its extrema it is monotonic, so bisection finds every root.
  const auto slope = [&](double s) { return 1.0 + s * (3.0 * k1 + s * (5.0 * k2 + s * 7.0 * k3)); };
  const double a = 21.0 * k3, b = 10.0 * k2, c = 3.0 * k1;  // its derivative: a s^2 + b s + c
  std::vector<double> ends;
  if (a == 0.0) {
    if (b != 0.0) ends.push_back(-c / b);
  } else if (const double under = b * b - 4.0 * a * c; under > 0.0) {
    // The formula avoids the cancellation of the school's one (Numerical Recipes, 3rd ed., eq. 5.6.4 and
    // 5.6.5).
    const double q = -0.5 * (b + std::copysign(std::sqrt(under), b));
    ends.push_back(q / a);
    if (q != 0.0) ends.push_back(c / q);
  }
  std::ranges::sort(ends);
  ends.push_back(infinity);
  double low = 0.0;
  for (double high : ends) {
    if (!(high > low)) continue;
    if (high == infinity) {
      high = std::max(1.0, 2.0 * low);
      for (int i = 0; i < 200 && slope(high) > 0.0; ++i) high *= 2.0;
    }
    if (!(slope(high) > 0.0)) {
      for (int i = 0; i < 200; ++i) {
        const double middle = 0.5 * (low + high);
        (slope(middle) > 0.0 ? low : high) = middle;
      }
      return std::sqrt(low);
    }
    low = high;
  }
  return infinity;
}

Lens::Lens(const LensGeometry& geometry) : geometry_(geometry) {
  GREATX_CHECK(geometry.width > 0 && geometry.height > 0 && geometry.fx > 0.0 && geometry.fy > 0.0,
               "camera {}: {}x{} pixels", geometry.name, geometry.width, geometry.height);
  find_bounds();
}

dvec2 Lens::normalised(const dvec2& pixel) const {
  return {(pixel.x - geometry_.cx) / geometry_.fx, (pixel.y - geometry_.cy) / geometry_.fy};
}

dvec2 Lens::inverse(const dvec2& distorted) const {
  const Distortion& d = geometry_.distortion;
  if (!d.any()) return distorted;
  const double radius = glm::length(distorted);
  dvec2 start = distorted;
  if (radius > 0.0) start *= radial_inverse(d, radius) / radius;
  const std::optional<dvec2> found = newton(d, distorted, start);
  return found ? *found : dvec2(std::numeric_limits<double>::quiet_NaN());
}

dvec2 Lens::undistorted(const dvec2& pixel) const { return inverse(normalised(pixel)); }

dvec2 Lens::pixel(const dvec2& undistorted) const {
  const dvec2 at = geometry_.distortion.distort(undistorted);
  return {geometry_.cx + geometry_.fx * at.x, geometry_.cy + geometry_.fy * at.y};
}

void Lens::find_bounds() {
  bounds_ = {dvec2(infinity), dvec2(-infinity)};
  double bend = 0.0;
  const auto along = [&](const dvec2& from, const dvec2& to, uint32_t steps) {
    dvec2 last(0.0), before(0.0);
    for (uint32_t i = 0; i <= steps; ++i) {
      const dvec2 pixel = glm::mix(from, to, double(i) / steps), distorted = normalised(pixel);
      const dvec2 u = inverse(distorted);
      if (std::isnan(u.x) || !unfolded(geometry_.distortion, u)) fail(geometry_, pixel, distorted);
      bounds_.least = glm::min(bounds_.least, u);
      bounds_.most = glm::max(bounds_.most, u);
      if (i >= 2) bend = std::max(bend, glm::length(u - 2.0 * last + before));
      before = last;
      last = u;
    }
  };
  const double w = geometry_.width, h = geometry_.height;
  along({0.0, 0.0}, {w, 0.0}, geometry_.width);
  along({0.0, h}, {w, h}, geometry_.width);
  along({0.0, 0.0}, {0.0, h}, geometry_.height);
  along({w, 0.0}, {w, h}, geometry_.height);
  // Between two points a curve leaves its chord by an eighth of its second difference.
  bounds_.least -= dvec2(0.25 * bend);
  bounds_.most += dvec2(0.25 * bend);
}

std::vector<dvec2> Lens::centers() const {
  std::vector<dvec2> centers(size_t{geometry_.width} * geometry_.height);
  const Distortion& d = geometry_.distortion;
  for (uint32_t row = 0; row < geometry_.height; ++row) {
    dvec2 u(0.0), at(0.0);
    for (uint32_t column = 0; column < geometry_.width; ++column) {
      const dvec2 distorted = normalised({column + 0.5, row + 0.5});
      // The neighbour's solution, moved along, is closer than any other start.
      std::optional<dvec2> found;
      if (column > 0 && d.any())
        found = newton(d, distorted, u + glm::inverse(d.jacobian(u)) * (distorted - at));
      u = found ? *found : inverse(distorted);
      at = distorted;
      centers[size_t{row} * geometry_.width + column] = u;
    }
  }
  return centers;
}

std::vector<dvec2> Lens::centers(const dvec2& focal, const dvec2& principal) const {
  std::vector<dvec2> places = centers();
  for (dvec2& place : places) place = principal + focal * place;
  return places;
}

std::vector<float> flat_field(const Vignetting& vignetting, const LensGeometry& geometry) {
  const Lens lens(geometry);
  std::vector<dvec2> directions;
  if (vignetting.natural) directions = lens.centers();
  const double half_diagonal = 0.5 * std::hypot(geometry.width, geometry.height);
  std::vector<float> field(size_t{geometry.width} * geometry.height);
  for (size_t i = 0; i < field.size(); ++i) {
    const dvec2 pixel(double(i % geometry.width) + 0.5, double(i / geometry.width) + 0.5);
    const dvec2 from_axis = (pixel - dvec2(geometry.cx, geometry.cy)) / half_diagonal;
    const double s = glm::dot(from_axis, from_axis);
    const auto& [a1, a2, a3] = vignetting.radial;
    double factor = 1.0 + s * (a1 + s * (a2 + s * a3));
    if (vignetting.natural) {
      const double secant_squared = 1.0 + glm::dot(directions[i], directions[i]);
      factor /= secant_squared * secant_squared;
    }
    if (!(factor > 0.0 && factor <= 1.0))
      throw_user_error(
          "camera {}: vignetting: expected factors above 0 and up to 1, found {:.4g} at pixel ({}, {})",
          geometry.name, factor, pixel.x, pixel.y);
    field[i] = static_cast<float>(factor);
  }
  return field;
}

}  // namespace greatx::render
