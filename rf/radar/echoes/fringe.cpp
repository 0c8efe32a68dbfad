// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "rf/radar/echoes/fringe.h"

#include <algorithm>
#include <cmath>

#include "core/units.h"

namespace greatx::rf {
namespace {

constexpr double beside = 1e-3;         ///< rad about a boundary
constexpr double fringe_bend = 0.1;     ///< largest deviation of the phase from a linear one, rad
constexpr double far_from_flat = 20.0;  ///< slope^2 over bend from which only the ends of a stretch count

/// Returns the coefficients away from boundaries.
Fringe away(double n, double incident, double observed) {
  const double edge = std::cos(pi / n), factor = std::sin(pi / n) / n;
  const double direct = factor / (edge - std::cos((observed - incident) / n)),
               reflected = factor / (edge - std::cos((observed + incident) / n));
  Fringe rest{direct - reflected, direct + reflected};
  const auto physical_optics = [&](double in, double out) {
    if (in >= pi) return;  // the face is dark
    const double sum = std::cos(out) + std::cos(in);
    rest.soft -= std::sin(in) / sum;
    rest.hard += std::sin(out) / sum;
  };
  physical_optics(incident, observed);
  physical_optics(n * pi - incident, n * pi - observed);
  return rest;
}

/// Returns the distance of an angle from the nearest multiple of 2 pi.
double off_turn(double angle) { return std::abs(std::remainder(angle, 2.0 * pi)); }

}  // namespace

Fringe fringe(double n, double incident, double observed) {
  // The boundaries are where observed -+ incident is an odd multiple of pi, counted from either face.
  const double other_in = n * pi - incident, other_out = n * pi - observed;
  double least = 1e300;
  for (const double angle : {observed - incident, observed + incident, other_out + other_in})
    least = std::min(least, off_turn(angle - pi));
  if (least >= beside) return away(n, incident, observed);
  const Fringe low = away(n, incident, observed - 2.0 * beside),
               high = away(n, incident, observed + 2.0 * beside);
  return {0.5 * (low.soft + high.soft), 0.5 * (low.hard + high.hard)};
}

double PhaseLine::slope(double x) const {
  return -wavenumber * ((x - source.x) / std::hypot(x - source.x, source.y) +
                        (x - receiver.x) / std::hypot(x - receiver.x, receiver.y));
}

double PhaseLine::bend(double x) const {
  const auto of = [&](const dvec2& end) { return end.y * end.y / std::pow(std::hypot(x - end.x, end.y), 3); };
  return -wavenumber * (of(source) + of(receiver));
}

double PhaseLine::length(double x) const {
  return std::hypot(x - source.x, source.y) + std::hypot(x - receiver.x, receiver.y);
}

void integrate(const PhaseLine& line, double from, double to, std::vector<LineContribution>& out) {
  constexpr Complex j{0.0, 1.0};
  const double middle = 0.5 * (from + to), span = to - from;
  const double slope_a = line.slope(from), slope_b = line.slope(to);
  const double slope = std::min(std::abs(slope_a), std::abs(slope_b));
  const double bend =
      std::max({std::abs(line.bend(from)), std::abs(line.bend(middle)), std::abs(line.bend(to))});
  if (slope_a * slope_b > 0.0 && slope * slope > far_from_flat * bend && slope * span > pi) {
    // [e^{j phase}/(j slope) (1 - j bend/slope^2)], with the first correction of integration by parts.
    const auto end = [&](double x, double s, double sign) {
      out.push_back({x, sign * (-j / s) * (1.0 - j * (line.bend(x) / (s * s)))});
    };
    end(from, slope_a, -1.0), end(to, slope_b, 1.0);
    return;
  }
  if (bend * span * span < 8.0 * fringe_bend || span < 1e-9) {
    const double at_a = -line.wavenumber * (line.length(from) - line.length(middle)),
                 at_b = -line.wavenumber * (line.length(to) - line.length(middle));
    const double half = 0.5 * (at_b - at_a), sinc = std::abs(half) < 1e-4 ? 1.0 : std::sin(half) / half;
    // The phase is replaced by its chord, and the mean deviation from the chord is added.
    out.push_back({middle, span * sinc * std::polar(1.0, (at_a + at_b) / 6.0)});
    return;
  }
  integrate(line, from, middle, out);
  integrate(line, middle, to, out);
}

}  // namespace greatx::rf
