// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "rf/atmosphere/rain_backscatter.h"

#include <cmath>
#include <complex>
#include <vector>

#include "core/error.h"
#include "core/units.h"
#include "rf/atmosphere/water.h"

namespace greatx::rf {
namespace {

using ComplexIndex = std::complex<double>;

constexpr double largest_drop_mm = 7.0;
constexpr int drop_steps = 700;

double drops_per_m3_mm(double diameter_mm, double rain_mm_h) {
  return 8000.0 * std::exp(-4.1 * std::pow(rain_mm_h, -0.21) * diameter_mm);
}

double fall_m_s(double diameter_mm) { return std::max(0.0, 9.65 - 10.3 * std::exp(-0.6 * diameter_mm)); }

/// Returns psi'_n(z)/psi_n(z) for n = 0 .. count by downward recurrence, which is stable.
std::vector<ComplexIndex> logarithmic_derivatives(ComplexIndex z, int count) {
  const int start = std::max(count, static_cast<int>(std::abs(z))) + 16;
  std::vector<ComplexIndex> all(start + 1);
  for (int n = start; n > 0; --n) {
    const ComplexIndex ratio = double(n) / z;
    all[n - 1] = ratio - 1.0 / (all[n] + ratio);
  }
  return all;
}

}  // namespace

SphereSections sphere_sections(double diameter_m, double frequency_hz, double temperature_k) {
  const WaterPermittivity water = water_permittivity(frequency_hz, temperature_k);
  // The series is written for e^{-j omega t}, where losses have a positive imaginary part.
  const ComplexIndex index = std::sqrt(ComplexIndex(water.stored, water.lost));
  const double k = 2.0 * pi * frequency_hz / speed_of_light, x = 0.5 * k * diameter_m;
  const int count = static_cast<int>(x + 4.0 * std::cbrt(x) + 3.0);
  const auto slopes = logarithmic_derivatives(index * x, count);
  double psi_before = std::cos(x), psi = std::sin(x), chi_before = -std::sin(x), chi = std::cos(x);
  ComplexIndex back = 0.0;
  double extinction = 0.0, sign = -1.0;
  for (int n = 1; n <= count; ++n, sign = -sign) {
    const double psi_next = (2.0 * n - 1.0) / x * psi - psi_before;
    const double chi_next = (2.0 * n - 1.0) / x * chi - chi_before;
    const ComplexIndex xi(psi, -chi), xi_next(psi_next, -chi_next);
    const ComplexIndex electric = slopes[n] / index + double(n) / x,
                       magnetic = index * slopes[n] + double(n) / x;
    const ComplexIndex a = (electric * psi_next - psi) / (electric * xi_next - xi);
    const ComplexIndex b = (magnetic * psi_next - psi) / (magnetic * xi_next - xi);
    back += (2.0 * n + 1.0) * sign * (a - b);
    extinction += (2.0 * n + 1.0) * (a + b).real();
    psi_before = psi, psi = psi_next;
    chi_before = chi, chi = chi_next;
  }
  return {pi / (k * k) * std::norm(back), 2.0 * pi / (k * k) * extinction};
}

RainBackscatter rain_backscatter(double frequency_hz, double temperature_k, double rain_mm_h) {
  if (!rain_backscatter_covers(frequency_hz))
    throw_user_error("rain backscatter: expected a frequency from 1 to 300 GHz, found {:g} GHz",
                     frequency_hz / 1e9);
  GREATX_CHECK(rain_mm_h >= 0.0 && temperature_k > 0.0, "{} mm/h at {} K", rain_mm_h, temperature_k);
  if (rain_mm_h == 0.0) return {};
  constexpr double step_mm = largest_drop_mm / drop_steps;
  double eta = 0.0, lost = 0.0, fall = 0.0, fall_squared = 0.0;
  for (int i = 0; i < drop_steps; ++i) {
    const double diameter_mm = (i + 0.5) * step_mm;
    const SphereSections sections = sphere_sections(1e-3 * diameter_mm, frequency_hz, temperature_k);
    const double drops = drops_per_m3_mm(diameter_mm, rain_mm_h) * step_mm, speed = fall_m_s(diameter_mm);
    eta += drops * sections.back;
    lost += drops * sections.extinction;
    fall += drops * sections.back * speed;
    fall_squared += drops * sections.back * speed * speed;
  }
  fall /= eta;
  // A wave loses 10 log10(e) dB where the sections fill the area in front of it once.
  return {eta, 1e3 * 10.0 * std::log10(std::exp(1.0)) * lost, fall,
          std::sqrt(std::max(0.0, fall_squared / eta - fall * fall))};
}

}  // namespace greatx::rf
