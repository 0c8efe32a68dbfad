// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "tests/sim/navigation/allan.h"

#include <cmath>
#include <vector>

namespace greatx::test {

double allan_deviation(std::span<const double> samples, size_t count) {
  std::vector<double> sums(samples.size() + 1, 0.0);
  for (size_t i = 0; i < samples.size(); ++i) sums[i + 1] = sums[i] + samples[i];
  double squares = 0.0;
  size_t groups = 0;
  for (size_t i = 0; i + 2 * count <= samples.size(); ++i, ++groups) {
    const double difference = sums[i + 2 * count] - 2.0 * sums[i + count] + sums[i];
    squares += difference * difference;
  }
  const auto n = static_cast<double>(count);
  return std::sqrt(squares / (2.0 * static_cast<double>(groups) * n * n));
}

double gauss_markov_allan(double sigma, double time_s, double tau_s) {
  const double r = tau_s / time_s;
  return sigma * std::sqrt(2.0 / r * (1.0 - (3.0 - 4.0 * std::exp(-r) + std::exp(-2.0 * r)) / (2.0 * r)));
}

}  // namespace greatx::test
