// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "rf/edges/keller_points.h"

#include <algorithm>
#include <cmath>

#include "core/units.h"

namespace greatx::rf {
namespace {

/// Describes the length of a path over both lines: points a + z t on each.
class PathLength {
 public:
  PathLength(const scene::Wedge& first, const scene::Wedge& second, const dvec3& before, const dvec3& after)
      : a_{first.a, second.a},
        t_{glm::normalize(first.b - first.a), glm::normalize(second.b - second.a)},
        before_(before),
        after_(after) {}

  dvec3 point(int edge, const dvec2& z) const { return a_[edge] + z[edge] * t_[edge]; }
  double at(const dvec2& z) const {
    const dvec3 p = point(0, z), q = point(1, z);
    return glm::distance(before_, p) + glm::distance(p, q) + glm::distance(q, after_);
  }
  /// Returns the place on one line between two points, by unfolding.
  double between(int edge, const dvec3& from, const dvec3& to) const {
    const dvec3 u = from - a_[edge], v = to - a_[edge];
    const double zu = glm::dot(u, t_[edge]), zv = glm::dot(v, t_[edge]);
    const double du = glm::length(u - zu * t_[edge]), dv = glm::length(v - zv * t_[edge]);
    return du + dv > 0.0 ? (zu * dv + zv * du) / (du + dv) : 0.5 * (zu + zv);
  }
  /// Sets the slope of the length and Newton's step. Returns false where the length has no derivative.
  bool newton(const dvec2& z, dvec2& slope, dvec2& step) const {
    const dvec3 p = point(0, z), q = point(1, z);
    const double r[3] = {glm::distance(before_, p), glm::distance(p, q), glm::distance(q, after_)};
    if (std::min({r[0], r[1], r[2]}) <= 0.0) return false;
    const dvec3 u[3] = {(p - before_) / r[0], (q - p) / r[1], (after_ - q) / r[2]};
    const double c00 = glm::dot(t_[0], u[0]), c01 = glm::dot(t_[0], u[1]), c11 = glm::dot(t_[1], u[1]),
                 c12 = glm::dot(t_[1], u[2]);
    slope = {c00 - c01, c11 - c12};
    const double h00 = (1.0 - c00 * c00) / r[0] + (1.0 - c01 * c01) / r[1],
                 h11 = (1.0 - c11 * c11) / r[1] + (1.0 - c12 * c12) / r[2],
                 h01 = -(glm::dot(t_[0], t_[1]) - c01 * c11) / r[1];
    const double determinant = h00 * h11 - h01 * h01;
    if (!(determinant > 0.0)) return false;
    step = dvec2(h01 * slope.y - h11 * slope.x, h01 * slope.x - h00 * slope.y) / determinant;
    return true;
  }

 private:
  dvec3 a_[2], t_[2];
  dvec3 before_, after_;
};

/// Returns the places of the least length on both lines.
std::optional<dvec2> least(const PathLength& length, const dvec2& start, const dvec3& before,
                           const dvec3& after) {
  dvec2 z = start;
  for (int turn = 0; turn < 3; ++turn) {
    z.x = length.between(0, before, length.point(1, z));
    z.y = length.between(1, length.point(0, z), after);
  }
  dvec2 slope, step;
  double here = length.at(z);
  for (int iteration = 0; iteration < 40; ++iteration) {
    if (!length.newton(z, slope, step)) return std::nullopt;
    if (glm::length(step) <= 1e-13 * here) return z + step;
    double scale = 1.0;
    dvec2 next = z + step;
    // Rounding alone may lengthen the path by a little.
    while (length.at(next) > here * (1.0 + 1e-15) && scale > 1e-3) next = z + (scale *= 0.5) * step;
    if (scale <= 1e-3) break;
    z = next;
    here = length.at(z);
  }
  return glm::length(slope) < 1e-9 ? std::optional(z) : std::nullopt;
}

/// Tells whether a point between the edges may be in the exterior of one of them: a common face may be uneven.
bool nearly_in_exterior(const scene::Wedge& wedge, const dvec3& point) {
  if (in_exterior(wedge, point)) return true;
  const dvec3 from = point - wedge.a;
  const double x = glm::dot(wedge.tangent_0, from), y = glm::dot(wedge.normal_0, from);
  const double angle = std::atan2(y, x), wide = wedge.n * pi, past = angle < 0.0 ? angle + 2.0 * pi : angle;
  const double off = std::min(past - wide, 2.0 * pi - past);
  return off <= coplanar_rad || (off <= parallel_rad && off * std::hypot(x, y) <= coplanar_m);
}

double from_line(const scene::Wedge& wedge, const dvec3& point) {
  const dvec3 along = glm::normalize(wedge.b - wedge.a), from = point - wedge.a;
  return glm::length(from - glm::dot(from, along) * along);
}

}  // namespace

std::optional<KellerPoints> keller_points(const scene::Wedge& first, const scene::Wedge& second,
                                          const dvec3& before, const dvec3& after) {
  if (!in_exterior(first, before) || !in_exterior(second, after)) return std::nullopt;
  const double lengths[2] = {glm::distance(first.a, first.b), glm::distance(second.a, second.b)};
  const PathLength length(first, second, before, after);
  const std::optional<dvec2> z = least(length, dvec2(0.5 * lengths[0], 0.5 * lengths[1]), before, after);
  if (!z) return std::nullopt;
  const double tolerance[2] = {edge_tolerance_m(first), edge_tolerance_m(second)};
  for (int edge = 0; edge < 2; ++edge)
    if (!((*z)[edge] >= -tolerance[edge] && (*z)[edge] <= lengths[edge] + tolerance[edge]))
      return std::nullopt;
  const KellerPoints points{length.point(0, *z), length.point(1, *z)};
  if (glm::distance(points.first, points.second) < least_edge_gap_m) return std::nullopt;
  if (from_line(first, before) <= tolerance[0] || from_line(first, points.second) <= tolerance[0] ||
      from_line(second, points.first) <= tolerance[1] || from_line(second, after) <= tolerance[1])
    return std::nullopt;
  if (!nearly_in_exterior(first, points.second) || !nearly_in_exterior(second, points.first))
    return std::nullopt;
  return points;
}

double least_two_edge_loss_db(const scene::Wedge& first, const scene::Wedge& second, const dvec3& before,
                              const KellerPoints& points, const dvec3& after, double wave_number) {
  const double r[3] = {glm::distance(before, points.first), glm::distance(points.first, points.second),
                       glm::distance(points.second, after)};
  const double sum = r[0] + r[1] + r[2], joint = (r[0] + r[1]) * (r[1] + r[2]);
  const auto terms = [&](const scene::Wedge& wedge, const dvec3& from, const dvec3& at, const dvec3& to,
                         double distance_m) {
    const UtdFactors factors =
        utd_factors(utd_angles(wedge.n, across(wedge, from - at), across(wedge, to - at)));
    const double cosine = glm::dot(glm::normalize(wedge.b - wedge.a), glm::normalize(at - from));
    const double w = std::sqrt(2.0 * wave_number * distance_m * std::max(0.0, 1.0 - cosine * cosine));
    double most = 0.0;
    for (const UtdFactor& factor : factors.factors)
      most += std::abs(factor.amplitude) / std::max(1.0, std::sqrt(pi) * w * factor.half_sine);
    return most;
  };
  // L is least for parallel edges, and the integral is at most twice the product of both edges'.
  const double rest = r[1] / joint * sum;  // 1 - rho^2
  const double most = 2.0 *
                      terms(first, before, points.first, points.second, rest * r[0] * (r[1] + r[2]) / sum) *
                      terms(second, points.first, points.second, after, rest * r[2] * (r[0] + r[1]) / sum);
  return -20.0 * std::log10(most);
}

}  // namespace greatx::rf
