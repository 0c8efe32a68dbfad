// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Phases are counted in turns. At 140 GHz and 33 us a path is 4.6 million turns long. The whole turns are
// taken off while the product is still exact, and only the fraction goes into sin and cos.
#pragma once

#include <cmath>
#include <complex>

#include "core/units.h"

namespace greatx::rf {

/// Holds a product exactly: a * b = value + error (Dekker; the fused multiply-add makes it two operations).
struct ExactProduct {
  double value, error;
};
inline ExactProduct exact_product(double a, double b) {
  const double value = a * b;
  return {value, std::fma(a, b, -value)};
}

/// Returns the turns less the nearest whole number of turns, in [-1/2, 1/2].
inline double fraction_of_turn(double turns) { return turns - std::nearbyint(turns); }

/// Returns frequency * delay without its whole turns, in about [-1/2, 1/2], to 1e-16 turns.
inline double turns_of(double frequency_hz, double delay_s) {
  const ExactProduct product = exact_product(frequency_hz, delay_s);
  return fraction_of_turn(fraction_of_turn(product.value) + product.error);
}

/// Returns (count * spacing) * delay without its whole turns. The frequency is exact too.
inline double turns_of(double count, double spacing_hz, double delay_s) {
  const ExactProduct frequency = exact_product(count, spacing_hz);
  return fraction_of_turn(turns_of(frequency.value, delay_s) + frequency.error * delay_s);
}

/// Returns the product without the checks for infinite values that operator* makes.
template <typename Part>
std::complex<Part> plain_product(std::complex<Part> a, std::complex<Part> b) {
  return {a.real() * b.real() - a.imag() * b.imag(), a.real() * b.imag() + a.imag() * b.real()};
}

/// Returns e^{j 2 pi turns}.
inline std::complex<double> unit_phasor(double turns) {
  const double angle = 2.0 * pi * turns;
  return {std::cos(angle), std::sin(angle)};
}

}  // namespace greatx::rf
