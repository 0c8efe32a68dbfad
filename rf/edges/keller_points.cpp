// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "rf/edges/keller_points.h"

#include <algorithm>
#include <cmath>
#include <limits>

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
  double slope_along_first(const dvec2& z) const {
    const dvec3 p = point(0, z), from = p - before_, to = p - point(1, z);
    if (glm::length(to) < 1e-9) return std::numeric_limits<double>::quiet_NaN();
    return glm::dot(t_[0], from) / glm::length(from) + glm::dot(t_[0], to) / glm::length(to);
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

/// Returns the slope of the length along the first line at a place on it, with the best place on the second
/// line, to which `z` is set. The slope rises along the line. NaN where both lines meet.
double slope_at(const PathLength& length, double place, const dvec3& after, dvec2& z) {
  z.x = place;
  z.y = length.between(1, length.point(0, z), after);
  return length.slope_along_first(z);
}

/// Returns the places of the least length on both lines, if the first is between `low` and `high`. Nearly all
/// pairs of edges are refused by the slopes at both ends.
std::optional<dvec2> least(const PathLength& length, double low, double high, const dvec3& after) {
  dvec2 z;
  const double inwards = 1e-6 * (high - low);
  double at_low = slope_at(length, low, after, z);
  if (std::isnan(at_low)) at_low = slope_at(length, low += inwards, after, z);
  if (!(at_low <= 0.0)) return std::nullopt;
  double at_high = slope_at(length, high, after, z);
  if (std::isnan(at_high)) at_high = slope_at(length, high -= inwards, after, z);
  if (!(at_high >= 0.0)) return std::nullopt;
  // Regula falsi with Illinois' rule, then Newton's method on both places.
  double weight_low = at_low, weight_high = at_high;
  int side = 0;
  for (int i = 0; i < 100 && high - low > 1e-7 * (1.0 + std::abs(low)); ++i) {
    const double share = weight_high > weight_low ? -weight_low / (weight_high - weight_low) : 0.5;
    const double place = i % 4 == 3 ? 0.5 * (low + high) : low + share * (high - low);
    const double slope = slope_at(length, place, after, z);
    if (std::abs(slope) < 1e-12) break;
    if (slope < 0.0) {
      low = place, weight_low = slope;
      if (side == -1) weight_high *= 0.5;
      side = -1;
    } else {
      high = place, weight_high = slope;
      if (side == 1) weight_low *= 0.5;
      side = 1;
    }
  }
  dvec2 slope, step;
  for (int i = 0; i < 10; ++i) {
    if (!length.newton(z, slope, step)) return std::nullopt;
    z += step;
    if (glm::length(step) <= 1e-13 * length.at(z)) break;
  }
  return glm::length(slope) < 1e-6 ? std::optional(z) : std::nullopt;
}

bool share_a_face(const scene::Wedge& first, const scene::Wedge& second) {
  const auto has = [&](uint32_t facet) {
    return facet != scene::no_facet && (facet == second.facet_0 || facet == second.facet_n);
  };
  return has(first.facet_0) || has(first.facet_n);
}

/// Tells whether a point between the edges may be in the exterior of one of them: a common face may be
/// uneven.
bool nearly_in_exterior(const scene::Wedge& wedge, const dvec3& point) {
  const dvec2 at = across(wedge, point - wedge.a);
  const double angle = std::atan2(at.y, at.x), wide = wedge.n * pi,
               past = angle < 0.0 ? angle + 2.0 * pi : angle;
  const double off = std::min(past - wide, 2.0 * pi - past);
  return off <= coplanar_rad || (off <= parallel_rad && off * std::hypot(at.x, at.y) <= coplanar_m);
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
  const double tolerance[2] = {edge_tolerance_m(first), edge_tolerance_m(second)};
  const std::optional<dvec2> z = least(length, -tolerance[0], lengths[0] + tolerance[0], after);
  if (!z) return std::nullopt;
  for (int edge = 0; edge < 2; ++edge)
    if (!((*z)[edge] >= -tolerance[edge] && (*z)[edge] <= lengths[edge] + tolerance[edge]))
      return std::nullopt;
  const KellerPoints points{length.point(0, *z), length.point(1, *z)};
  if (glm::distance(points.first, points.second) < least_edge_gap_m) return std::nullopt;
  if (from_line(first, before) <= tolerance[0] || from_line(first, points.second) <= tolerance[0] ||
      from_line(second, points.first) <= tolerance[1] || from_line(second, after) <= tolerance[1])
    return std::nullopt;
  const auto reaches = [&](const scene::Wedge& wedge, const dvec3& point) {
    return in_exterior(wedge, point) || (share_a_face(first, second) && nearly_in_exterior(wedge, point));
  };
  if (!reaches(first, points.second) || !reaches(second, points.first)) return std::nullopt;
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
