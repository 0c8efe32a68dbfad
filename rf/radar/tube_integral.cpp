// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "rf/radar/tube_integral.h"

#include <algorithm>
#include <cmath>

#include "core/error.h"
#include "core/units.h"

namespace greatx::rf {
namespace {

constexpr Complex j{0.0, 1.0};

double cross(const dvec2& a, const dvec2& b) { return a.x * b.y - a.y * b.x; }

double sinc(double x) { return std::abs(x) < 1e-4 ? 1.0 - x * x / 6.0 : std::sin(x) / x; }

Complex turned(double phase) { return {std::cos(phase), std::sin(phase)}; }

double quadratic(const dvec3& m, const dvec2& v) {
  return m.x * v.x * v.x + 2.0 * m.y * v.x * v.y + m.z * v.y * v.y;
}

/// Second moments of the area about the centroid: (xx, xy, yy), m^4.
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
  // The mean of the quadratic part over the piece.
  const double mean = 0.5 * (bend.x * moments.x + 2.0 * bend.y * moments.y + bend.z * moments.z) / area;
  out.push_back({centroid, linear_phase_integral(piece, centroid, plane.gradient(centroid)) * turned(mean)});
}

/// The density of the border form at a point of a side with outward normal n: -j V . n (1 + j div V).
Complex border_density(const PhasePlane& plane, const dvec2& p, const dvec2& normal) {
  const dvec2 g = plane.gradient(p);
  const dvec3 bend = plane.curvature(p);
  const double squared = glm::dot(g, g);
  const double divergence = (bend.x + bend.z) / squared - 2.0 * quadratic(bend, g) / (squared * squared);
  return -j * (glm::dot(g, normal) / squared) * (1.0 + j * divergence);
}

/// One side from a to b, along the unit vector `along`.
void add_side(const PhasePlane& plane, const dvec2& a, const dvec2& b, const dvec2& along,
              const IntegralLimits& limits, int depth, std::vector<Contribution>& out) {
  const dvec2 normal(along.y, -along.x), middle = 0.5 * (a + b);
  const double length = glm::dot(b - a, along);
  const double slope_a = glm::dot(plane.gradient(a), along), slope_b = glm::dot(plane.gradient(b), along);
  const double bend_a = quadratic(plane.curvature(a), along), bend_b = quadratic(plane.curvature(b), along);
  const double bend_middle = quadratic(plane.curvature(middle), along);
  const double bend = std::max({std::abs(bend_a), std::abs(bend_b), std::abs(bend_middle)});
  const double slope = std::min(std::abs(slope_a), std::abs(slope_b));
  const bool turns = slope_a * slope_b <= 0.0;  // the phase has an extremum on the way
  if (!turns && slope * slope > limits.stationary * bend && slope * length > pi) {
    // [e^{j phase}/(j slope) (1 - j bend/slope^2)] from a to b: the first correction of integration by parts.
    const auto end = [&](const dvec2& p, double s, double c, double sign) {
      out.push_back(
          {p, sign * border_density(plane, p, normal) * (-j / s) * (1.0 - j * (c / (s * s))), true});
    };
    end(b, slope_b, bend_b, 1.0);
    end(a, slope_a, bend_a, -1.0);
    return;
  }
  if (bend * length * length < 8.0 * limits.bend || depth == 0) {
    const double phase_a = -plane.wavenumber * (plane.length(a) - plane.length(middle));
    const double phase_b = -plane.wavenumber * (plane.length(b) - plane.length(middle));
    // Over the chord of the phase, plus the mean of what the phase leaves above the chord.
    const double chord = 0.5 * (phase_a + phase_b), mean = chord - (2.0 / 3.0) * chord;
    out.push_back(
        {middle,
         border_density(plane, middle, normal) * length * sinc(0.5 * (phase_b - phase_a)) * turned(mean),
         true});
    return;
  }
  add_side(plane, a, middle, along, limits, depth - 1, out);
  add_side(plane, middle, b, along, limits, depth - 1, out);
}

void add_border(const PhasePlane& plane, const Polygon& piece, uint32_t omitted, const IntegralLimits& limits,
                std::vector<Contribution>& out) {
  for (uint32_t i = 0; i < piece.size(); ++i) {
    if ((omitted >> i) & 1u) continue;
    const dvec2 side = piece.next(i) - piece[i];
    const double length = glm::length(side);
    if (length > 0.0) add_side(plane, piece[i], piece.next(i), side / length, limits, 24, out);
  }
}

/// Halves across the direction of the farthest corner. Sides keep their mark.
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

void integrate_piece(const PhasePlane& plane, const Polygon& piece, uint32_t omitted,
                     const IntegralLimits& limits, int depth, std::vector<Contribution>& out) {
  if (piece.empty()) return;
  const IntegralForm form = depth == 0 ? IntegralForm::area : integral_form(plane, piece, limits);
  if (form == IntegralForm::area) return add_area(plane, piece, out);
  if (form == IntegralForm::border) return add_border(plane, piece, omitted, limits, out);
  const Halves halves = halves_of(piece, omitted);
  integrate_piece(plane, halves.first, halves.omitted_first, limits, depth - 1, out);
  integrate_piece(plane, halves.second, halves.omitted_second, limits, depth - 1, out);
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
  const dvec2 centroid = piece.centroid();
  const double reach = reach_of(piece, centroid);
  const double bend = plane.curvature_bound(centroid, reach);
  const double slope = glm::length(plane.gradient(centroid)), least = slope - bend * reach;
  if (least > 0.0 && least * least > limits.stationary * bend && least * reach > pi)
    return IntegralForm::border;
  if (0.5 * bend * reach * reach < limits.bend) return IntegralForm::area;
  return IntegralForm::split;
}

void integrate(const PhasePlane& plane, const Polygon& piece, uint32_t omitted,
               std::vector<Contribution>& out, const IntegralLimits& limits) {
  integrate_piece(plane, piece, omitted, limits, 40, out);
}

Complex linear_phase_integral(const Polygon& piece, const dvec2& centroid, const dvec2& gradient) {
  const double reach = reach_of(piece, centroid), squared = glm::dot(gradient, gradient);
  if (squared * reach * reach < 4e-4) {  // to second order; the third is below 2e-6 of the area
    const double area = piece.area();
    return area - 0.5 * quadratic(second_moments(piece, centroid), gradient);
  }
  Complex sum(0.0);
  for (uint32_t i = 0; i < piece.size(); ++i) {
    const dvec2 a = piece[i] - centroid, b = piece.next(i) - centroid, side = b - a;
    const dvec2 outward(side.y, -side.x);  // times its length
    sum += glm::dot(outward, gradient) * sinc(0.5 * glm::dot(gradient, side)) *
           turned(0.5 * glm::dot(gradient, a + b));
  }
  return -j * sum / squared;
}

}  // namespace greatx::rf
