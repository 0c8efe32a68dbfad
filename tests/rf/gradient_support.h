// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Differentiates functions numerically, for tests of exact derivatives.
#pragma once

#include <algorithm>
#include <cmath>
#include <functional>
#include <vector>

#include "rf/antenna/spherical.h"

namespace greatx::rf::testing {

using Values = std::vector<Complex>;

/// Returns the derivative at 0 by central differences with two steps of Richardson's extrapolation: its error
/// is of the sixth order of the step.
inline Values numeric_slope(const std::function<Values(double)>& function, double step) {
  const auto central = [&](double h) {
    Values after = function(h);
    const Values before = function(-h);
    for (size_t i = 0; i < after.size(); ++i) after[i] = (after[i] - before[i]) / (2.0 * h);
    return after;
  };
  Values wide = central(step), half = central(0.5 * step);
  const Values quarter = central(0.25 * step);
  for (size_t i = 0; i < wide.size(); ++i) {
    const Complex first = (4.0 * half[i] - wide[i]) / 3.0, second = (4.0 * quarter[i] - half[i]) / 3.0;
    half[i] = (16.0 * second - first) / 15.0;
  }
  return half;
}

/// Returns the largest difference relative to the largest value of `expected`; the difference itself if all
/// expected values are 0.
inline double relative_error(const Values& found, const Values& expected) {
  double difference = 0.0, most = 0.0;
  for (size_t i = 0; i < expected.size(); ++i) {
    difference = std::max(difference, std::abs(found.at(i) - expected[i]));
    most = std::max(most, std::abs(expected[i]));
  }
  return most > 0.0 ? difference / most : difference;
}

}  // namespace greatx::rf::testing
