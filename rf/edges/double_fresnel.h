// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Computes the transition function of two edges, which takes the place of the product of two Fresnel
// integrals. It is the field behind two half-planes in units of the ray over both edges (L. E. Vogler, "An
// attenuation function for multiple knife-edge diffraction", Radio Science 17(6), 1982, for N = 2):
//
//   V(w_1, w_2, rho) = (4 sqrt(1 - rho^2)/pi) int_0^inf int_0^inf
//                      exp(-u^2 - v^2 + 2 rho u v - 2 e^{j pi/4} (w_1 u + w_2 v)) du dv.
//
// With polar coordinates in the (u, v) of the quadratic form the inner integral is closed, and
//
//   V = (4/pi) int_0^omega g(B(x)) dx,   B(x) = e^{j pi/4} (w_1 sin(omega - x) + w_2 sin(x))/sin(omega),
//   g(B) = 1/2 - (sqrt(pi)/2) B erfcx(B),   cos(omega) = -rho.
//
// V(w_1, w_2, 0) = erfcx(e^{j pi/4} w_1) erfcx(e^{j pi/4} w_2), and V(0, 0, rho) = 1 + (2/pi) arcsin(rho).
#pragma once

#include <complex>

#include "rf/edges/utd.h"

namespace greatx::rf {

template <typename R>
struct DoubleFresnelOf {
  ComplexOf<R> value = 1.0;  ///< V
  /// The same integral with the factor u, and with the factor v: -(1/2) dV/d(e^{j pi/4} w).
  ComplexOf<R> moment_1 = 0.0, moment_2 = 0.0;
};
using DoubleFresnel = DoubleFresnelOf<double>;

/// Returns V for w_1, w_2 >= 0. The correlation is given as rho and sqrt(1 - rho^2) > 0, of which a caller
/// may know the second more accurately. The relative error of the value is below 2e-8 for |rho| <= 0.9999
/// (`DoubleFresnel.*`), with 24 nodes.
template <typename R = double>
DoubleFresnelOf<R> double_fresnel(const Given<R>& w_1, const Given<R>& w_2, const Given<R>& rho,
                                  const Given<R>& sine);

/// Returns erfcx(z) = e^{z^2} erfc(z) for any z whose result is finite. The relative error is below 1e-11 for
/// Re z >= 0 (J. A. C. Weideman, "Computation of the complex error function", SIAM J. Numer. Anal. 31(5),
/// 1994, with 40 terms).
Complex erfcx(Complex z);

}  // namespace greatx::rf
