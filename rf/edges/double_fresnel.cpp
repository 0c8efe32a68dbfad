// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "rf/edges/double_fresnel.h"

#include <array>
#include <cmath>

#include "core/error.h"
#include "core/units.h"

namespace greatx::rf {
namespace {

constexpr int half_nodes = 12;

/// Holds the nodes and weights of Gauss and Legendre on [0, 1].
struct GaussRule {
  std::array<double, half_nodes> at, weight;
};

GaussRule make_gauss_rule() {
  GaussRule rule{};
  for (int i = 0; i < half_nodes; ++i) {
    double x = std::cos(pi * (i + 0.75) / (half_nodes + 0.5)), slope = 0.0;
    for (int step = 0; step < 8; ++step) {  // Newton on the Legendre polynomial
      double before = 1.0, value = x;
      for (int n = 2; n <= half_nodes; ++n) {
        const double next = ((2 * n - 1) * x * value - (n - 1) * before) / n;
        before = value, value = next;
      }
      slope = half_nodes * (x * value - before) / (x * x - 1.0);
      x -= value / slope;
    }
    rule.at[i] = 0.5 * (1.0 - x);
    rule.weight[i] = 1.0 / ((1.0 - x * x) * slope * slope);
  }
  return rule;
}

/// Holds g(B) and -g'(B)/2 at B = e^{j pi/4} w.
template <typename R>
struct RadialIntegral {
  ComplexOf<R> value, moment;
};

RadialIntegral<double> radial_integral(double w) {
  static const Complex diagonal = std::polar(1.0, 0.25 * pi);
  constexpr double far = 8.0;
  if (w < far) {
    const Complex b = diagonal * w, e = erfcx_on_diagonal(w);
    return {0.5 - 0.5 * std::sqrt(pi) * b * e, 0.25 * std::sqrt(pi) * (1.0 + 2.0 * b * b) * e - 0.5 * b};
  }
  // Both cancel far out. There the asymptotic series in z = 1/(2 B^2) is exact to 1e-13.
  const Complex z(0.0, -0.5 / (w * w));
  Complex term = 1.0, value = 0.0, moment = 0.0;
  for (int k = 0; k < 12; ++k) {
    term *= (k == 0 ? 1.0 : -(2.0 * k + 1.0)) * z;
    value += term;
    moment += (k + 1.0) * term;
  }
  return {0.5 * value, moment / (2.0 * diagonal * w)};
}

/// Returns the derivative of the moment by B: (sqrt(pi)/2) B (3 + 2 B^2) erfcx(B) - 1 - B^2.
Complex moment_slope(double w) {
  static const Complex diagonal = std::polar(1.0, 0.25 * pi);
  constexpr double far = 6.0;
  const Complex b = diagonal * w;
  if (w < far) return 0.5 * std::sqrt(pi) * b * (3.0 + 2.0 * b * b) * erfcx_on_diagonal(w) - 1.0 - b * b;
  // The derivative of the asymptotic series of the moment, term by term.
  const Complex z(0.0, -0.5 / (w * w));
  Complex term = 1.0, sum = 0.0;
  for (int k = 0; k < 16; ++k) {
    term *= (k == 0 ? 1.0 : -(2.0 * k + 1.0)) * z;
    sum += (k + 1.0) * (2.0 * k + 3.0) * term;
  }
  return -z * sum;
}

/// With dg/dw = e^{j pi/4} g'(B) = -2 e^{j pi/4} moment.
RadialIntegral<Dual> radial_integral(const Dual& w) {
  static const Complex diagonal = std::polar(1.0, 0.25 * pi);
  const RadialIntegral<double> at = radial_integral(w.value);
  const Complex by_w = -2.0 * diagonal * at.moment, bend = diagonal * moment_slope(w.value);
  return {{w.mapped(at.value.real(), by_w.real()), w.mapped(at.value.imag(), by_w.imag())},
          {w.mapped(at.moment.real(), bend.real()), w.mapped(at.moment.imag(), bend.imag())}};
}

/// Integrates over x from 0 to omega/2, where B rises from w_1. With t = tan(x), B is cos(x) (w_1 + slope t),
/// so that the integrand far out, 1/(4 B^2) dx, is a constant in s of t = t_0 s/(1 - s).
template <typename R>
DoubleFresnelOf<R> half_of(const R& w_1, const R& w_2, const R& omega, const R& rho, const R& sine) {
  using std::atan, std::cos, std::sin, std::tan;
  static const GaussRule rule = make_gauss_rule();
  constexpr double room = 1.5;
  const R slope = (w_2 + w_1 * rho) / sine, end = 0.5 * omega;
  const bool steep = slope > w_1 + room;
  const R t_0 = steep ? (w_1 + room) / slope : R(0.0), tangent = tan(end), s_end = tangent / (tangent + t_0);
  DoubleFresnelOf<R> sum{0.0, 0.0, 0.0};
  for (int i = 0; i < half_nodes; ++i) {
    R x = end * rule.at[i], dx = end;
    if (steep) {
      const R s = s_end * rule.at[i], t = t_0 * s / (1.0 - s);
      x = atan(t);
      dx = s_end * t_0 / ((1.0 - s) * (1.0 - s) * (1.0 + t * t));
    }
    const R from_1 = sin(omega - x) / sine, from_2 = sin(x) / sine;
    const RadialIntegral<R> g = radial_integral(w_1 * cos(x) + slope * sin(x));
    const R weight = rule.weight[i] * dx;
    sum.value += weight * g.value;
    sum.moment_1 += weight * from_1 * g.moment;
    sum.moment_2 += weight * from_2 * g.moment;
  }
  return sum;
}

/// Holds the coefficients of Weideman's rational series of w(j z) = erfcx(z).
struct Weideman {
  static constexpr int terms = 40;
  double scale = 0.0;
  std::array<double, terms> a{};
};

Weideman make_weideman() {
  Weideman series;
  constexpr int n = Weideman::terms, m = 4 * n;
  series.scale = std::sqrt(n / std::sqrt(2.0));
  for (int k = 1; k <= n; ++k) {
    double sum = 0.0;
    for (int i = -m / 2 + 1; i < m / 2; ++i) {
      const double theta = 2.0 * pi * i / m, t = series.scale * std::tan(0.5 * theta);
      sum += std::exp(-t * t) * (series.scale * series.scale + t * t) * std::cos(k * theta);
    }
    series.a[k - 1] = sum / m;
  }
  return series;
}

}  // namespace

template <typename R>
DoubleFresnelOf<R> double_fresnel(const Given<R>& w_1, const Given<R>& w_2, const Given<R>& rho,
                                  const Given<R>& sine) {
  using std::atan2;
  GREATX_CHECK(w_1 >= 0.0 && w_2 >= 0.0 && sine > 0.0, "w {} and {}, sqrt(1 - rho^2) {}", value_of(w_1),
               value_of(w_2), value_of(sine));
  const R omega = atan2(sine, R(-rho));
  const DoubleFresnelOf<R> near_1 = half_of<R>(w_1, w_2, omega, rho, sine),
                           near_2 = half_of<R>(w_2, w_1, omega, rho, sine);
  constexpr double scale = 4.0 / pi;
  return {scale * (near_1.value + near_2.value), scale * (near_1.moment_1 + near_2.moment_2),
          scale * (near_1.moment_2 + near_2.moment_1)};
}

template DoubleFresnel double_fresnel<double>(const double&, const double&, const double&, const double&);
template DoubleFresnelOf<Dual> double_fresnel<Dual>(const Dual&, const Dual&, const Dual&, const Dual&);

Complex erfcx(Complex z) {
  if (z.real() < 0.0) return 2.0 * std::exp(z * z) - erfcx(-z);
  static const Weideman series = make_weideman();
  const Complex down = 1.0 / (series.scale + z), ratio = (series.scale - z) * down;
  Complex sum = 0.0;
  for (int k = Weideman::terms; k-- > 0;) sum = sum * ratio + series.a[k];
  return 2.0 * sum * down * down + down / std::sqrt(pi);
}

}  // namespace greatx::rf
