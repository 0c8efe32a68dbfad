// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "rf/edges/utd.h"

#include <array>
#include <cmath>

#include "core/error.h"
#include "core/units.h"

namespace greatx::rf {
namespace {

constexpr Complex j{0.0, 1.0};
constexpr int node_count = 12;

/// Holds the nodes t_k = (k + 1/2) h and weights e^{-t_k^2} of the midpoint rule. The step h balances the
/// error of the rule, e^{-(pi/h)^2}, with the truncated tail, e^{-(node_count h)^2}.
struct MidpointRule {
  double step;
  std::array<double, node_count> squared_node, weight;
};

MidpointRule make_midpoint_rule() {
  MidpointRule rule{};
  rule.step = std::sqrt(pi / (node_count + 0.5));
  for (int k = 0; k < node_count; ++k) {
    const double node = (k + 0.5) * rule.step;
    rule.squared_node[k] = node * node;
    rule.weight[k] = std::exp(-node * node);
  }
  return rule;
}

constexpr bool adds_pi(uint32_t term) {
  return term == static_cast<uint32_t>(UtdTerm::shadow_n) ||
         term == static_cast<uint32_t>(UtdTerm::reflection_n);
}
constexpr bool reflects(uint32_t term) { return term >= static_cast<uint32_t>(UtdTerm::reflection_n); }

/// Returns N of a term: the number of whole turns of 2 n pi that is nearest to beta +- pi.
double turns_of(uint32_t term, const UtdAngles& angles, double& beta_and_pi) {
  const double beta = reflects(term) ? angles.observed + angles.incident : angles.observed - angles.incident;
  beta_and_pi = adds_pi(term) ? beta + pi : beta - pi;
  return std::nearbyint(beta_and_pi / (2.0 * angles.n * pi));
}

void check(const UtdAngles& angles) {
  const double wide = angles.n * pi + 1e-6;
  GREATX_CHECK(angles.n > 1.0 && angles.n <= 2.0, "an exterior of {} pi: expected (1, 2]", angles.n);
  GREATX_CHECK(angles.incident >= -1e-6 && angles.incident <= wide && angles.observed >= -1e-6 &&
                   angles.observed <= wide,
               "angles {} and {} of an exterior of {}", angles.incident, angles.observed, angles.n * pi);
}

/// Returns y cot y for |y| <= pi/2.
double y_cot_y(double y) { return y == 0.0 ? 1.0 : y / std::tan(y); }

/// Largest angle past a boundary at which EdgeSides count, rad.
constexpr double near_boundary_rad = 0.1;

int side_said(uint32_t term, const EdgeSides& sides) {
  if (!reflects(term)) return sides.incident;
  return term == static_cast<uint32_t>(UtdTerm::reflection_0) ? sides.reflected_0 : sides.reflected_n;
}

UtdFactor factor_of(uint32_t term, double delta, double n, int said) {
  const double half = 0.5 * delta, sine = std::abs(std::sin(half));
  const double sinc = half == 0.0 ? 1.0 : sine / std::abs(half);
  // The boundary itself belongs to the lit side: delta > 0 for the terms with + pi, delta < 0 for the others.
  const bool lit = said != 0 && std::abs(delta) < near_boundary_rad ? said > 0
                   : delta == 0.0                                   ? true
                                                                    : adds_pi(term) == (delta > 0.0);
  return {0.5 * (lit ? -1.0 : 1.0) * sinc * y_cot_y(0.5 * delta / n), sine, lit};
}

}  // namespace

Complex erfcx_on_diagonal(double w) {
  GREATX_CHECK(w >= 0.0, "argument {}", w);
  static const MidpointRule rule = make_midpoint_rule();
  const double squared = w * w;  // z = e^{j pi/4} w, z^2 = j w^2
  // (2 z h/pi) sum e^{-t^2}/(z^2 + t^2)
  double re = 0.0, im = 0.0;
  for (int k = 0; k < node_count; ++k) {
    const double t2 = rule.squared_node[k];
    if (squared < 1e10) {
      const double share = rule.weight[k] / (squared * squared + t2 * t2);
      re += share * t2;
      im -= share * squared;
    } else {  // t^4 is negligible beside w^4, which may overflow
      re += rule.weight[k] * (t2 / squared) / squared;
      im -= rule.weight[k] / squared;
    }
  }
  const double scale = std::sqrt(2.0) * w * rule.step / pi;  // 2 z h/pi = scale (1 + j)
  Complex value(scale * (re - im), scale * (re + im));
  // The residue of the pole at t = jz, which the rule leaves out: 2 e^{z^2}/(1 + e^{2 pi z/h}). Beyond
  // e^{-40} it is negligible.
  const double decay = std::sqrt(2.0) * pi * w / rule.step;
  if (decay < 40.0) {
    const Complex shrunk = std::polar(std::exp(-decay), -decay);
    value += 2.0 * std::polar(1.0, squared) * shrunk / (1.0 + shrunk);
  }
  return value;
}

UtdAngles utd_angles(double n, double incident, double observed) {
  UtdAngles angles{n, incident, observed, {}};
  check(angles);
  for (uint32_t term = 0; term < 4; ++term) {
    double sum = 0.0;
    const double turns = turns_of(term, angles, sum);
    angles.delta[term] = sum - 2.0 * n * pi * turns;
  }
  return angles;
}

UtdAngles utd_angles(double n, const dvec2& source, const dvec2& observer) {
  // Clamps the angle into [0, n pi]. A point on a face may be off it by its tolerance, which is a
  // considerable angle near the edge.
  const double wide = n * pi;
  const auto from_face_0 = [&](const dvec2& direction) {
    const double turned = std::atan2(direction.y, direction.x);
    const double angle = turned < 0.5 * wide - pi ? turned + 2.0 * pi : turned;
    GREATX_CHECK(angle > -0.1 && angle < wide + 0.1, "angle {} of an exterior of {}", angle, wide);
    return std::min(std::max(angle, 0.0), wide);
  };
  UtdAngles angles = utd_angles(n, from_face_0(source), from_face_0(observer));
  for (uint32_t term = 0; term < 4; ++term) {
    if (std::abs(angles.delta[term]) > 1.0) continue;  // nothing cancels far from the boundary
    double sum = 0.0;
    const double turned = 2.0 * n * pi * turns_of(term, angles, sum);
    const dvec2 opposite(-source.x, reflects(term) ? source.y : -source.y);
    const double c = std::cos(turned), s = std::sin(turned);
    const dvec2 boundary =
        turned == 0.0 ? opposite : dvec2(c * opposite.x - s * opposite.y, s * opposite.x + c * opposite.y);
    angles.delta[term] =
        std::atan2(boundary.x * observer.y - boundary.y * observer.x, glm::dot(boundary, observer));
  }
  return angles;
}

bool UtdAngles::in_shadow() const {
  const double beta = observed - incident;
  const double past = beta > 0.0 ? delta[static_cast<uint32_t>(UtdTerm::shadow_0)]
                                 : -delta[static_cast<uint32_t>(UtdTerm::shadow_n)];
  // Near the boundary N = 0 and delta is exact; elsewhere the angles decide.
  const double rough = std::abs(beta) - pi;
  return std::abs(rough) < 0.5 ? past > 0.0 : rough > 0.0;
}

UtdFactors utd_factors(const UtdAngles& angles, const EdgeSides& sides) {
  UtdFactors result;
  for (uint32_t term = 0; term < 4; ++term)
    result.factors[term] = factor_of(term, angles.delta[term], angles.n, side_said(term, sides));
  return result;
}

Complex utd_value(const UtdFactor& factor, double wave_number, double distance_m) {
  return factor.amplitude * erfcx_on_diagonal(std::sqrt(2.0 * wave_number * distance_m) * factor.half_sine);
}

UtdTerms utd_terms(const UtdAngles& angles, double wave_number, double distance_m, const EdgeSides& sides) {
  GREATX_CHECK(wave_number > 0.0 && distance_m >= 0.0, "wave number {} rad/m, distance {} m", wave_number,
               distance_m);
  const UtdFactors factors = utd_factors(angles, sides);
  UtdTerms terms;
  for (uint32_t term = 0; term < 4; ++term)
    terms.d[term] = utd_value(factors.factors[term], wave_number, distance_m);
  return terms;
}

FaceAngles luebbers_angles(const UtdAngles& angles) {
  const double wide = angles.n * pi;
  double nearness = 0.5 * wide - angles.incident;
  if (std::abs(nearness) < 1e-9) nearness = angles.observed - 0.5 * wide;
  // The clamps only remove rounding: the nearer face is at most half of the exterior away, and the exterior
  // is at most 2 pi wide.
  const auto incident_at = [](double incident) { return std::min(std::max(incident, 0.0), pi); };
  const auto leaving_for = [](double observed) { return pi - std::min(std::max(observed, 0.0), 0.5 * pi); };
  if (nearness >= 0.0) return {incident_at(angles.incident), leaving_for(wide - angles.observed), true};
  return {leaving_for(angles.observed), incident_at(wide - angles.incident), false};
}

}  // namespace greatx::rf
