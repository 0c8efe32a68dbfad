// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "rf/radar/signal/window.h"

#include <algorithm>
#include <cmath>

namespace greatx::rf {
namespace {

/// Returns c_0 .. c_{nbar-1} of Taylor's window.
std::vector<double> taylor(int nbar, double sidelobe_db) {
  const double a = std::acosh(std::pow(10.0, sidelobe_db / 20.0)) / pi, aa = a * a;
  const double spread = nbar * nbar / (aa + (nbar - 0.5) * (nbar - 0.5));
  std::vector<double> coefficients{1.0};
  for (int m = 1; m < nbar; ++m) {
    double above = m % 2 ? 1.0 : -1.0, below = 1.0;
    for (int i = 1; i < nbar; ++i) {
      above *= 1.0 - m * m / spread / (aa + (i - 0.5) * (i - 0.5));
      if (i != m) below *= 1.0 - double(m * m) / (i * i);
    }
    coefficients.push_back(above / below);  // 2 F_m
  }
  return coefficients;
}

std::vector<double> coefficients_of(RadarWindow kind) {
  switch (kind) {
    case RadarWindow::rectangular:
      return {1.0};
    case RadarWindow::hann:
      return {0.5, 0.5};
    case RadarWindow::hamming:
      return {0.54, 0.46};
    case RadarWindow::blackman:
      return {0.42, 0.5, 0.08};
    case RadarWindow::taylor:
      return taylor(4, 35.0);
  }
  return {1.0};
}

/// Returns sum_n e^{j 2 pi bins (n - h)/size}, where h is size/2 rounded down.
std::complex<double> kernel_of(double bins, uint32_t size) {
  const double turns = bins / size, whole = std::nearbyint(turns);
  const double lean = pi * turns * (double(size) - 1.0 - 2.0 * double(size / 2));
  // At multiples of `size` all terms are 1. The limit of the quotient then has a sign, which cancels that of
  // the phase of `lean`.
  const double top = std::sin(pi * (bins - whole * size)), bottom = std::sin(pi * (turns - whole));
  const double sum = std::abs(bottom) < 1e-15 ? size : top / bottom;
  const double sign = std::fmod(std::abs(whole), 2.0) == 0.0 || size % 2 == 1 ? 1.0 : -1.0;
  return sum * std::polar(1.0, lean) * sign;  // polar() takes no negative magnitude
}

}  // namespace

Window::Window(RadarWindow kind, uint32_t size) : coefficients_(coefficients_of(kind)) {
  // If the size is less than twice the number of cosines, the cosines alias. Sums are right for any size,
  // closed forms are not.
  double sum = 0.0, squares = 0.0;
  for (uint32_t n = 0; n < size; ++n) {
    double value = 0.0;
    for (size_t m = 0; m < coefficients_.size(); ++m)
      value += coefficients_[m] * std::cos(2.0 * pi * double(m) * (double(n) - size / 2) / size);
    values_.push_back(static_cast<float>(value));
    sum += value;
    squares += value * value;
  }
  gain_ = sum / size;
  bandwidth_ = size * squares / (sum * sum);
  if (size < 4) return;
  constexpr int steps = 256;
  for (int i = 0; i <= steps; ++i) ratios_.push_back(neighbour_ratio(0.5 * i / steps));
}

std::complex<double> Window::response(double bins) const {
  std::complex<double> sum = coefficients_[0] * kernel_of(bins, size());
  for (size_t m = 1; m < coefficients_.size(); ++m)
    sum +=
        0.5 * coefficients_[m] * (kernel_of(bins + double(m), size()) + kernel_of(bins - double(m), size()));
  return sum / (gain_ * size());
}

double Window::noise_correlation(uint32_t bins) const {
  std::complex<double> sum = 0.0;
  double squares = 0.0;
  for (uint32_t n = 0; n < size(); ++n) {
    const double square = double(values_[n]) * values_[n];
    sum += square * std::polar(1.0, 2.0 * pi * double(uint64_t{bins} * n % size()) / size());
    squares += square;
  }
  return std::abs(sum) / squares;
}

double Window::neighbour_ratio(double offset) const { return power(1.0 - offset) / power(offset); }

double Window::peak_offset(double before, double peak, double after) const {
  if (!(peak > 0.0) || size() < 4) return 0.0;
  const double ratio = std::max(before, after) / peak, sign = after >= before ? 1.0 : -1.0;
  if (ratio <= ratios_.front()) return 0.0;
  if (ratio >= ratios_.back()) return 0.5 * sign;
  const auto above = std::upper_bound(ratios_.begin(), ratios_.end(), ratio);
  const double step = 0.5 / double(ratios_.size() - 1);
  double low = step * double(above - ratios_.begin() - 1), high = low + step;
  double low_fault = *(above - 1) - ratio, high_fault = *above - ratio;
  // Secant steps within the bracket.
  for (int i = 0; i < 4; ++i) {
    const double middle = low - low_fault * (high - low) / (high_fault - low_fault);
    const double fault = neighbour_ratio(middle) - ratio;
    if (fault == 0.0) return sign * middle;
    (fault < 0.0 ? low : high) = middle;
    (fault < 0.0 ? low_fault : high_fault) = fault;
  }
  return sign * (-low_fault < high_fault ? low : high);
}

}  // namespace greatx::rf
