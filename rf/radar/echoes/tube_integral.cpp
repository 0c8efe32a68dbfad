// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "rf/radar/echoes/tube_integral.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "core/error.h"
#include "core/units.h"

namespace greatx::rf {
namespace {

constexpr Complex j{0.0, 1.0};

double sinc(double x) { return std::abs(x) < 1e-4 ? 1.0 - x * x / 6.0 : std::sin(x) / x; }

Complex turned(double phase) { return {std::cos(phase), std::sin(phase)}; }

double quadratic(const dvec3& m, const dvec2& v) {
  return m.x * v.x * v.x + 2.0 * m.y * v.x * v.y + m.z * v.y * v.y;
}

/// Returns the second moments of the area about the centroid: (xx, xy, yy), m^4.
dvec3 second_moments(const Polygon& piece, const dvec2& centroid) {
  dvec3 sum(0.0);
  for (uint32_t i = 0; i < piece.size(); ++i) {
    const dvec2 a = piece[i] - centroid, b = piece.next(i) - centroid;
    const double twelfth = cross(a, b) / 12.0;
    sum.x += twelfth * (a.x * a.x + a.x * b.x + b.x * b.x);
    sum.y += twelfth * (a.x * a.y + 0.5 * (a.x * b.y + b.x * a.y) + b.x * b.y);
    sum.z += twelfth * (a.y * a.y + a.y * b.y + b.y * b.y);
  }
  return sum;
}

double reach_of(const Polygon& piece, const dvec2& centroid) {
  double squared = 0.0;
  for (uint32_t i = 0; i < piece.size(); ++i)
    squared = std::max(squared, glm::dot(piece[i] - centroid, piece[i] - centroid));
  return std::sqrt(squared);
}

void add_area(const PhasePlane& plane, const Polygon& piece, std::vector<Contribution>& out) {
  const dvec2 centroid = piece.centroid();
  const double area = piece.area();
  if (!(area > 0.0)) return;
  const dvec3 bend = plane.curvature(centroid), moments = second_moments(piece, centroid);
  // The mean of the quadratic part of the phase over the piece.
  const double mean = 0.5 * (bend.x * moments.x + 2.0 * bend.y * moments.y + bend.z * moments.z) / area;
  out.push_back({centroid, linear_phase_integral(piece, centroid, plane.gradient(centroid)) * turned(mean)});
}

/// Returns the density of the border form at a point of a side with outward normal n: -j V . n (1 + j div V).
Complex border_density(const PhasePlane& plane, const dvec2& p, const dvec2& normal) {
  const dvec2 g = plane.gradient(p);
  const dvec3 bend = plane.curvature(p);
  const double squared = glm::dot(g, g);
  const double divergence = (bend.x + bend.z) / squared - 2.0 * quadratic(bend, g) / (squared * squared);
  return -j * (glm::dot(g, normal) / squared) * (1.0 + j * divergence);
}

/// Holds the state of the border form of one piece.
struct Border {
  const PhasePlane& plane;
  const IntegralLimits& limits;
  double most_bend = 0.0;  ///< bound on the curvature on the piece
  std::vector<Contribution>& out;
  uint64_t below = 0;

  void add(const dvec2& at, Complex value) {
    if (std::norm(value) < limits.floor * limits.floor)
      ++below;
    else
      out.push_back({at, value, true});
  }
  /// Returns whether both ends of a side are far from stationary and below the floor, without computing them.
  /// |density| is at most (1 + 3 bend/gradient^2)/gradient. The contribution of an end is at most this times
  /// (1 + bend/slope^2)/slope.
  bool faint(double slope, double gradient, double length) const {
    const double squared = slope * slope;
    if (!(limits.floor > 0.0 && squared > limits.stationary * most_bend && slope * length > pi)) return false;
    const double most = (1.0 + 3.0 * most_bend / (gradient * gradient)) * (1.0 + most_bend / squared);
    return most < limits.floor * gradient * slope;
  }
};

/// Adds one side from a to b. `along` is its unit vector; the gradients of the phase are those at both ends.
void add_side(Border& border, const dvec2& a, const dvec2& b, const dvec2& along, const dvec2& gradient_a,
              const dvec2& gradient_b, int depth) {
  const PhasePlane& plane = border.plane;
  const IntegralLimits& limits = border.limits;
  const dvec2 normal(along.y, -along.x), middle = 0.5 * (a + b);
  const double length = glm::dot(b - a, along);
  const double slope_a = glm::dot(gradient_a, along), slope_b = glm::dot(gradient_b, along);
  const double slope = std::min(std::abs(slope_a), std::abs(slope_b));
  const bool turns = slope_a * slope_b <= 0.0;  // the phase has an extremum on the side
  const double gradient =
      std::sqrt(std::min(glm::dot(gradient_a, gradient_a), glm::dot(gradient_b, gradient_b)));
  if (!turns && border.faint(slope, gradient, length)) {
    border.below += 2;
    return;
  }
  const double bend_a = quadratic(plane.curvature(a), along), bend_b = quadratic(plane.curvature(b), along);
  const double bend_middle = quadratic(plane.curvature(middle), along);
  const double bend = std::max({std::abs(bend_a), std::abs(bend_b), std::abs(bend_middle)});
  if (!turns && slope * slope > limits.stationary * bend && slope * length > pi) {
    // [e^{j phase}/(j slope) (1 - j bend/slope^2)] from a to b, with the first correction of integration by
    // parts.
    const auto end = [&](const dvec2& p, double s, double c, double sign) {
      border.add(p, sign * border_density(plane, p, normal) * (-j / s) * (1.0 - j * (c / (s * s))));
    };
    end(b, slope_b, bend_b, 1.0);
    end(a, slope_a, bend_a, -1.0);
    return;
  }
  if (bend * length * length < 8.0 * limits.bend || depth == 0) {
    const double phase_a = -plane.wavenumber * (plane.length(a) - plane.length(middle));
    const double phase_b = -plane.wavenumber * (plane.length(b) - plane.length(middle));
    // The phase is replaced by its chord. The mean deviation of the phase from the chord is added afterwards.
    const double chord = 0.5 * (phase_a + phase_b), mean = chord - (2.0 / 3.0) * chord;
    border.add(middle, border_density(plane, middle, normal) * length * sinc(0.5 * (phase_b - phase_a)) *
                           turned(mean));
    return;
  }
  const dvec2 gradient_middle = plane.gradient(middle);
  add_side(border, a, middle, along, gradient_a, gradient_middle, depth - 1);
  add_side(border, middle, b, along, gradient_middle, gradient_b, depth - 1);
}

uint64_t add_border(const PhasePlane& plane, const Polygon& piece, uint32_t omitted,
                    const IntegralLimits& limits, double most_bend, std::vector<Contribution>& out) {
  if (omitted == (1u << piece.size()) - 1u) return 0;
  Border border{plane, limits, most_bend, out};
  std::array<dvec2, Polygon::capacity> gradients;
  for (uint32_t i = 0; i < piece.size(); ++i) gradients[i] = plane.gradient(piece[i]);
  for (uint32_t i = 0; i < piece.size(); ++i) {
    if ((omitted >> i) & 1u) continue;
    const dvec2 side = piece.next(i) - piece[i];
    const double length = glm::length(side);
    const uint32_t next = i + 1 < piece.size() ? i + 1 : 0;
    if (length > 0.0)
      add_side(border, piece[i], piece[next], side / length, gradients[i], gradients[next], 24);
  }
  return border.below;
}

/// Holds the halves of a piece, cut across the direction to the farthest corner. Their sides inherit the
/// omitted bits.
struct Halves {
  Polygon first, second;
  uint32_t omitted_first = 0, omitted_second = 0;
};

uint32_t inherited(const Polygon& whole, uint32_t omitted, const Polygon& part) {
  uint32_t marks = 0;
  if (omitted == 0) return marks;
  for (uint32_t side = 0; side < whole.size(); ++side) {
    if (((omitted >> side) & 1u) == 0) continue;
    const HalfPlane line = whole.inside(side);
    const double room = 1e-9 * glm::dot(line.normal, line.normal);
    for (uint32_t i = 0; i < part.size(); ++i)
      if (std::abs(line.at(part[i])) < room && std::abs(line.at(part.next(i))) < room) marks |= 1u << i;
  }
  return marks;
}

Halves halves_of(const Polygon& piece, uint32_t omitted) {
  const dvec2 centroid = piece.centroid();
  dvec2 farthest(0.0);
  for (uint32_t i = 0; i < piece.size(); ++i) {
    const dvec2 arm = piece[i] - centroid;
    if (glm::dot(arm, arm) > glm::dot(farthest, farthest)) farthest = arm;
  }
  const HalfPlane cut{farthest, -glm::dot(farthest, centroid)};
  Halves halves{piece.clipped(cut), piece.clipped({-cut.normal, -cut.offset})};
  halves.omitted_first = inherited(piece, omitted, halves.first);
  halves.omitted_second = inherited(piece, omitted, halves.second);
  return halves;
}

/// Holds the form of the integral over a piece, and the bound on the curvature that led to it.
struct Choice {
  IntegralForm form;
  double most_bend = 0.0;
};

Choice choice_of(const PhasePlane& plane, const Polygon& piece, const IntegralLimits& limits) {
  const dvec2 centroid = piece.centroid();
  const double reach = reach_of(piece, centroid);
  const double bend = plane.curvature_bound(centroid, reach);
  const double slope = glm::length(plane.gradient(centroid)), least = slope - bend * reach;
  if (least > 0.0 && least * least > limits.stationary * bend && least * reach > pi)
    return {IntegralForm::border, bend};
  if (0.5 * bend * reach * reach < limits.bend) return {IntegralForm::area, bend};
  return {IntegralForm::split, bend};
}

uint64_t integrate_piece(const PhasePlane& plane, const Polygon& piece, uint32_t omitted,
                         const IntegralLimits& limits, int depth, std::vector<Contribution>& out) {
  if (piece.empty()) return 0;
  const Choice choice = depth == 0 ? Choice{IntegralForm::area} : choice_of(plane, piece, limits);
  if (choice.form == IntegralForm::area) {
    add_area(plane, piece, out);
    return 0;
  }
  if (choice.form == IntegralForm::border)
    return add_border(plane, piece, omitted, limits, choice.most_bend, out);
  const Halves halves = halves_of(piece, omitted);
  const uint64_t below = integrate_piece(plane, halves.first, halves.omitted_first, limits, depth - 1, out);
  return below + integrate_piece(plane, halves.second, halves.omitted_second, limits, depth - 1, out);
}

}  // namespace

double PhasePlane::length(const dvec2& p) const {
  return glm::length(dvec3(p, 0.0) - source) + glm::length(dvec3(p, 0.0) - receiver);
}

dvec2 PhasePlane::gradient(const dvec2& p) const {
  const dvec3 a = dvec3(p, 0.0) - source, b = dvec3(p, 0.0) - receiver;
  return -wavenumber * (dvec2(a) / glm::length(a) + dvec2(b) / glm::length(b));
}

dvec3 PhasePlane::curvature(const dvec2& p) const {
  dvec3 sum(0.0);
  for (const dvec3& end : {source, receiver}) {
    const dvec3 arm = dvec3(p, 0.0) - end;
    const double r = glm::length(arm);
    const dvec2 u = dvec2(arm) / r;
    sum += dvec3(1.0 - u.x * u.x, -u.x * u.y, 1.0 - u.y * u.y) / r;
  }
  return -wavenumber * sum;
}

double PhasePlane::curvature_bound(const dvec2& p, double reach) const {
  double sum = 0.0;
  for (const dvec3& end : {source, receiver}) {
    const double off = std::max(0.0, glm::length(p - dvec2(end)) - reach);
    sum += 1.0 / std::max(1e-6, std::sqrt(off * off + end.z * end.z));
  }
  return wavenumber * sum;
}

IntegralForm integral_form(const PhasePlane& plane, const Polygon& piece, const IntegralLimits& limits) {
  return choice_of(plane, piece, limits).form;
}

uint64_t integrate(const PhasePlane& plane, const Polygon& piece, uint32_t omitted,
                   std::vector<Contribution>& out, const IntegralLimits& limits) {
  return integrate_piece(plane, piece, omitted, limits, 40, out);
}

double most_of(const PhasePlane& plane, const Polygon& piece) {
  const dvec2 centroid = piece.centroid();
  const double area = piece.area(), reach = reach_of(piece, centroid);
  const double bend = plane.curvature_bound(centroid, reach) * reach;
  const dvec2 gradient = plane.gradient(centroid);
  const double least = glm::length(gradient) - bend;
  if (!(least > 0.0)) return area;
  double sum = 0.0;
  for (uint32_t i = 0; i < piece.size(); ++i) {
    const dvec2 side = piece.next(i) - piece[i];
    const double length = glm::length(side);
    const double slope = std::abs(glm::dot(gradient, side)) - bend * length;  // times the length
    sum += slope > 2.0 ? 2.0 * length / slope : length;
  }
  return std::min(area, sum / least);
}

Complex linear_phase_integral(const Polygon& piece, const dvec2& centroid, const dvec2& gradient) {
  const double reach = reach_of(piece, centroid), squared = glm::dot(gradient, gradient);
  if (squared * reach * reach < 4e-4) {  // to second order; the third order is below 2e-6 of the area
    const double area = piece.area();
    return area - 0.5 * quadratic(second_moments(piece, centroid), gradient);
  }
  Complex sum(0.0);
  for (uint32_t i = 0; i < piece.size(); ++i) {
    const dvec2 a = piece[i] - centroid, b = piece.next(i) - centroid, side = b - a;
    const dvec2 outward(side.y, -side.x);  // outward normal times the length of the side
    sum += glm::dot(outward, gradient) * sinc(0.5 * glm::dot(gradient, side)) *
           turned(0.5 * glm::dot(gradient, a + b));
  }
  return -j * sum / squared;
}

}  // namespace greatx::rf
