// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "rf/radar/signal/tone_kernel.h"

#include <cmath>

#include "core/units.h"

namespace greatx::rf {
namespace {

constexpr int taps = ToneKernel::taps;
constexpr int nodes = 96;  ///< number of values of x at which the taps are fitted

using Taps = std::array<double, taps>;

uint32_t grid_for(uint32_t samples) {
  for (uint32_t power = 8;; power *= 2)
    for (const uint32_t grid : {power, power / 2 * 3})
      if (2 * uint64_t{grid} >= 3 * uint64_t{samples}) return grid;
}

/// Solves G y = b for a symmetric positive definite G, which is factored once (Cholesky).
class Cholesky {
 public:
  explicit Cholesky(std::array<Taps, taps> matrix) : l_(matrix) {
    for (int i = 0; i < taps; ++i)
      for (int j = 0; j <= i; ++j) {
        double sum = l_[i][j];
        for (int k = 0; k < j; ++k) sum -= l_[i][k] * l_[j][k];
        l_[i][j] = i == j ? std::sqrt(sum) : sum / l_[j][j];
      }
  }
  Taps solve(Taps b) const {
    for (int i = 0; i < taps; ++i) {
      for (int k = 0; k < i; ++k) b[i] -= l_[i][k] * b[k];
      b[i] /= l_[i][i];
    }
    for (int i = taps - 1; i >= 0; --i) {
      for (int k = i + 1; k < taps; ++k) b[i] -= l_[k][i] * b[k];
      b[i] /= l_[i][i];
    }
    return b;
  }

 private:
  std::array<Taps, taps> l_;
};

/// Describes the least-squares problem of one oversampling M/N.
class TapFit {
 public:
  explicit TapFit(double oversampling) : turn_(pi / oversampling) {
    const double w = taps, s = oversampling;
    beta_ = pi * std::sqrt(w * w / (s * s) * (s - 0.5) * (s - 0.5) - 0.8);
    for (int i = 0; i < nodes; ++i) {
      const double angle = pi * (i + 0.5) / nodes;
      x_[i] = std::cos(angle);
      for (int k = 0; k < ToneKernel::orders; ++k) bent_[k][i] = std::cos(2 * k * angle) / scale(x_[i]);
    }
  }

  /// Returns the transform of the Kaiser-Bessel window at x, 1 at 0, by which tones are damped.
  double scale(double x) const {
    const auto shape = [](double squared) {
      const double root = std::sqrt(squared);
      return root < 1e-9 ? 1.0 : std::sinh(root) / root;
    };
    const double argument = 0.5 * taps * turn_ * x;
    return shape(beta_ * beta_ - argument * argument) / shape(beta_ * beta_);
  }

  Cholesky normal_equations() const {
    std::array<Taps, taps> gram{};
    for (int i = 0; i < taps; ++i)
      for (int j = 0; j < taps; ++j)
        for (const double x : x_) gram[i][j] += std::cos(turn_ * x * (i - j)) / (scale(x) * scale(x));
    return Cholesky(gram);
  }

  /// Returns the taps for T_2k(x) at `place` in [0, 1) above the lower grid frequency.
  Taps fit(const Cholesky& equations, int k, double place) const {
    Taps right{};
    for (int j = 0; j < taps; ++j)
      for (int i = 0; i < nodes; ++i)
        right[j] += std::cos(turn_ * x_[i] * (j + ToneKernel::first_tap - place)) * bent_[k][i];
    return equations.solve(right);
  }

 private:
  double turn_;  ///< rad between neighbouring grid frequencies at x = 1
  double beta_;
  std::array<double, nodes> x_;
  std::array<std::array<double, nodes>, ToneKernel::orders> bent_;  ///< T_2k(x)/scale(x)
};

}  // namespace

ToneKernel::ToneKernel(uint32_t samples) : samples_(samples), grid_(grid_for(samples)) {
  const TapFit problem(double(grid_) / samples_);
  const Cholesky equations = problem.normal_equations();
  const double half = 0.5 * samples_;
  for (uint32_t n = 0; n < samples_; ++n)
    correction_.push_back(static_cast<float>(1.0 / problem.scale((double(n) - samples_ / 2) / half)));
  table_.resize(size_t(orders) * segments * 3 * taps);
  for (int k = 0; k < orders; ++k)
    for (int segment = 0; segment < segments; ++segment) {
      // The parabola runs through the Chebyshev nodes of the segment.
      const double r = 0.25 * std::sqrt(3.0), u[3] = {0.5 - r, 0.5, 0.5 + r};
      Taps v[3];
      for (int i = 0; i < 3; ++i) v[i] = problem.fit(equations, k, (segment + u[i]) / segments);
      float* row = table_.data() + (size_t(k) * segments + segment) * 3 * taps;
      for (int j = 0; j < taps; ++j) {
        const double a = (v[2][j] - 2.0 * v[1][j] + v[0][j]) / (2.0 * r * r);
        const double b = (v[2][j] - v[0][j]) / (2.0 * r) - a;
        row[j] = static_cast<float>(a);
        row[taps + j] = static_cast<float>(b);
        row[2 * taps + j] = static_cast<float>(v[1][j] - 0.25 * a - 0.5 * b);
      }
    }
}

}  // namespace greatx::rf
