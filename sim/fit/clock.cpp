// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "sim/fit/clock.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "core/phase.h"

namespace greatx::sim {
namespace {

using rf::plain_product;
using rf::turns_of;
using rf::unit_phasor;

double number_of(uint32_t k, const FitBand& band) {
  return static_cast<double>(k) - static_cast<double>(band.subcarriers / 2);
}

double step_s(const FitBand& band) { return 0.25 / (band.subcarriers * band.spacing_hz); }

/// Returns |sum of product_k e^{+j 2 pi f_k t}|^2.
double correlation(const FitBand& band, std::span<const rf::Complex> product, double clock_s) {
  const rf::Complex step = unit_phasor(turns_of(band.spacing_hz, clock_s));
  rf::Complex phasor = unit_phasor(turns_of(number_of(0, band), band.spacing_hz, clock_s)), sum = 0.0;
  for (uint32_t k = 0; k < band.subcarriers; ++k) {
    sum += plain_product(product[k], phasor);
    phasor = plain_product(phasor, step);
  }
  return std::norm(sum);
}

}  // namespace

std::vector<rf::Complex> clock_turn(const FitBand& band, double clock_s) {
  std::vector<rf::Complex> turn(band.subcarriers);
  for (uint32_t k = 0; k < band.subcarriers; ++k)
    turn[k] = unit_phasor(-turns_of(number_of(k, band), band.spacing_hz, clock_s));
  return turn;
}

double clock_steps(const FitBand& band, double low_s, double high_s) {
  return std::ceil((high_s - low_s) / step_s(band)) + 1.0;
}

double best_clock(const FitBand& band, std::span<const rf::Complex> modelled,
                  std::span<const rf::Complex> measured, double low_s, double high_s) {
  std::vector<rf::Complex> product(band.subcarriers);
  for (uint32_t k = 0; k < band.subcarriers; ++k)
    product[k] = plain_product(std::conj(modelled[k]), measured[k]);
  const auto at = [&](double clock_s) { return correlation(band, product, clock_s); };
  const auto steps = static_cast<uint32_t>(clock_steps(band, low_s, high_s));
  double best_s = low_s, most = -1.0;
  for (uint32_t i = 0; i < steps; ++i) {
    const double clock_s = std::min(high_s, low_s + i * step_s(band)), value = at(clock_s);
    if (value > most) most = value, best_s = clock_s;
  }
  double low = std::max(low_s, best_s - step_s(band)), high = std::min(high_s, best_s + step_s(band));
  constexpr double golden = 0.6180339887498949;
  double a = high - golden * (high - low), b = low + golden * (high - low), at_a = at(a), at_b = at(b);
  while (high - low > 1e-6 * step_s(band)) {
    if (at_a > at_b) {
      high = b, b = a, at_b = at_a;
      a = high - golden * (high - low), at_a = at(a);
    } else {
      low = a, a = b, at_a = at_b;
      b = low + golden * (high - low), at_b = at(b);
    }
  }
  return 0.5 * (low + high);
}

}  // namespace greatx::sim
