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
template <typename R>
double turns_of(uint32_t term, const UtdAnglesOf<R>& angles, R& beta_and_pi) {
  const R beta = reflects(term) ? angles.observed + angles.incident : angles.observed - angles.incident;
  beta_and_pi = adds_pi(term) ? beta + pi : beta - pi;
  return std::nearbyint(value_of(beta_and_pi) / (2.0 * angles.n * pi));
}

template <typename R>
void check(const UtdAnglesOf<R>& angles) {
  const double wide = angles.n * pi + 1e-6;
  GREATX_CHECK(angles.n > 1.0 && angles.n <= 2.0, "an exterior of {} pi: expected (1, 2]", angles.n);
  GREATX_CHECK(angles.incident >= -1e-6 && angles.incident <= wide && angles.observed >= -1e-6 &&
                   angles.observed <= wide,
               "angles {} and {} of an exterior of {}", value_of(angles.incident), value_of(angles.observed),
               angles.n * pi);
}

/// Returns y cot y for |y| <= pi/2. Its slope at 0 is 0.
template <typename R>
R y_cot_y(const R& y) {
  using std::tan;
  return y == 0.0 ? R(1.0) : y / tan(y);
}

/// Largest angle past a boundary at which EdgeSides count, rad.
constexpr double near_boundary_rad = 0.1;

int side_said(uint32_t term, const EdgeSides& sides) {
  if (!reflects(term)) return sides.incident;
  return term == static_cast<uint32_t>(UtdTerm::reflection_0) ? sides.reflected_0 : sides.reflected_n;
}

/// Returns |x|. Its slope at 0 is that of the side that counts.
double modulus_of(double x, bool) { return std::abs(x); }
Dual modulus_of(const Dual& x, bool rises) { return x.value == 0.0 ? (rises ? x : -x) : abs(x); }

template <typename R>
UtdFactorOf<R> factor_of(uint32_t term, const R& delta, double n, int said) {
  using std::abs, std::sin;
  const R half = 0.5 * delta;
  // The boundary itself belongs to the lit side: delta > 0 for the terms with + pi, delta < 0 for the others.
  const bool lit = said != 0 && abs(delta) < near_boundary_rad ? said > 0
                   : delta == 0.0                              ? true
                                                               : adds_pi(term) == (delta > 0.0);
  const R sine = modulus_of(sin(half), adds_pi(term) == lit);
  const R sinc = half == 0.0 ? R(1.0) : sine / abs(half);
  return {0.5 * (lit ? -1.0 : 1.0) * sinc * y_cot_y<R>(0.5 * delta / n), sine, lit};
}

/// Returns erfcx'(z) = 2 z erfcx(z) - 2/sqrt(pi) for z = e^{j pi/4} w. Far out both terms cancel, and the
/// asymptotic series (2/sqrt(pi)) sum (-1)^k (2k - 1)!!/(2 z^2)^k, k from 1 on, is exact to rounding.
Complex erfcx_slope(double w, const Complex& value) {
  constexpr double far = 7.0;
  if (w < far) return 2.0 * std::polar(w, 0.25 * pi) * value - 2.0 / std::sqrt(pi);
  const Complex step(0.0, 0.5 / (w * w));  // -1/(2 z^2)
  Complex term = 1.0, sum = 0.0;
  for (int k = 1; k < 24; ++k) {
    const Complex next = (2.0 * k - 1.0) * step * term;
    if (std::abs(next) >= std::abs(term)) break;
    term = next;
    sum += term;
  }
  return 2.0 / std::sqrt(pi) * sum;
}

}  // namespace

template <>
Complex erfcx_on_diagonal<double>(const double& w) {
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

/// With z = e^{j pi/4} w, d erfcx(z)/dw = e^{j pi/4} (2 z erfcx(z) - 2/sqrt(pi)).
template <>
DualComplex erfcx_on_diagonal<Dual>(const Dual& w) {
  static const Complex diagonal = std::polar(1.0, 0.25 * pi);
  const Complex value = erfcx_on_diagonal<double>(w.value);
  const Complex derivative = diagonal * erfcx_slope(w.value, value);
  return {w.mapped(value.real(), derivative.real()), w.mapped(value.imag(), derivative.imag())};
}

template <typename R>
UtdAnglesOf<R> utd_angles(double n, const Given<R>& incident, const Given<R>& observed) {
  UtdAnglesOf<R> angles{n, incident, observed, {}};
  check(angles);
  for (uint32_t term = 0; term < 4; ++term) {
    R sum = 0.0;
    const double turns = turns_of(term, angles, sum);
    angles.delta[term] = sum - 2.0 * n * pi * turns;
  }
  return angles;
}

template <typename R>
UtdAnglesOf<R> utd_angles(double n, const Vec2Of<R>& source, const Vec2Of<R>& observer) {
  using std::abs, std::atan2;
  // Clamps the angle into [0, n pi]. A point on a face may be off it by its tolerance, which is a
  // considerable angle near the edge.
  const double wide = n * pi;
  const auto from_face_0 = [&](const Vec2Of<R>& direction) {
    const R turned = atan2(direction.y, direction.x);
    const R angle = turned < 0.5 * wide - pi ? turned + 2.0 * pi : turned;
    GREATX_CHECK(angle > -0.1 && angle < wide + 0.1, "angle {} of an exterior of {}", value_of(angle), wide);
    return std::min(std::max(angle, R(0.0)), R(wide));
  };
  UtdAnglesOf<R> angles = utd_angles<R>(n, from_face_0(source), from_face_0(observer));
  for (uint32_t term = 0; term < 4; ++term) {
    if (abs(angles.delta[term]) > 1.0) continue;  // nothing cancels far from the boundary
    R sum = 0.0;
    const double turned = 2.0 * n * pi * turns_of(term, angles, sum);
    const Vec2Of<R> opposite(-source.x, reflects(term) ? source.y : -source.y);
    const double c = std::cos(turned), s = std::sin(turned);
    const Vec2Of<R> boundary =
        turned == 0.0 ? opposite
                      : Vec2Of<R>(c * opposite.x - s * opposite.y, s * opposite.x + c * opposite.y);
    angles.delta[term] =
        atan2(R(boundary.x * observer.y - boundary.y * observer.x), R(dot(boundary, observer)));
  }
  return angles;
}

template <typename R>
bool UtdAnglesOf<R>::in_shadow() const {
  using std::abs;
  const R beta = observed - incident;
  const R past = beta > 0.0 ? delta[static_cast<uint32_t>(UtdTerm::shadow_0)]
                            : -delta[static_cast<uint32_t>(UtdTerm::shadow_n)];
  // Near the boundary N = 0 and delta is exact; elsewhere the angles decide.
  const R rough = abs(beta) - pi;
  return abs(rough) < 0.5 ? past > 0.0 : rough > 0.0;
}

template <typename R>
UtdFactorsOf<R> utd_factors(const UtdAnglesOf<Given<R>>& angles, const EdgeSides& sides) {
  UtdFactorsOf<R> result;
  for (uint32_t term = 0; term < 4; ++term)
    result.factors[term] = factor_of(term, angles.delta[term], angles.n, side_said(term, sides));
  return result;
}

template <typename R>
ComplexOf<R> utd_value(const UtdFactorOf<Given<R>>& factor, const Given<R>& wave_number,
                       const Given<R>& distance_m) {
  using std::sqrt;
  return factor.amplitude * erfcx_on_diagonal<R>(sqrt(2.0 * wave_number * distance_m) * factor.half_sine);
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

template <typename R>
FaceAnglesOf<R> luebbers_angles(const UtdAnglesOf<Given<R>>& angles) {
  using std::abs;
  const double wide = angles.n * pi;
  R nearness = 0.5 * wide - angles.incident;
  if (abs(nearness) < 1e-9) nearness = angles.observed - 0.5 * wide;
  // The clamps only remove rounding: the nearer face is at most half of the exterior away, and the exterior
  // is at most 2 pi wide.
  const auto incident_at = [](const R& incident) { return std::min(std::max(incident, R(0.0)), R(pi)); };
  const auto leaving_for = [](const R& observed) -> R {
    return pi - std::min(std::max(observed, R(0.0)), R(0.5 * pi));
  };
  if (nearness >= 0.0) return {incident_at(angles.incident), leaving_for(wide - angles.observed), true};
  return {leaving_for(angles.observed), incident_at(wide - angles.incident), false};
}

// The templates of this file, for doubles and for dual numbers.
#define GREATX_FOR(R)                                                                \
  template struct UtdAnglesOf<R>;                                                    \
  template UtdAnglesOf<R> utd_angles<R>(double, const R&, const R&);                 \
  template UtdAnglesOf<R> utd_angles<R>(double, const Vec2Of<R>&, const Vec2Of<R>&); \
  template UtdFactorsOf<R> utd_factors<R>(const UtdAnglesOf<R>&, const EdgeSides&);  \
  template ComplexOf<R> utd_value<R>(const UtdFactorOf<R>&, const R&, const R&);     \
  template FaceAnglesOf<R> luebbers_angles<R>(const UtdAnglesOf<R>&);
GREATX_FOR(double)
GREATX_FOR(Dual)
#undef GREATX_FOR

}  // namespace greatx::rf
