// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "sim/navigation/triad.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

namespace greatx::navigation {

Triad::Triad(const TriadErrors& errors, uint64_t seed, const std::string& name, uint32_t sequence,
             double step_s)
    : errors_(errors),
      noise_(errors.noise_density / std::sqrt(step_s)),
      white_(StreamKey(seed, fmt::format("{}/white", name), sequence)) {
  const NormalStream drawn(StreamKey(seed, fmt::format("{}/constant", name), sequence));
  uint64_t draw = 0;
  for (int axis = 0; axis < 3; ++axis) constant_[axis] = errors.bias_std * drawn.at(draw++);
  for (int row = 0; row < 3; ++row)
    for (int column = 0; column < 3; ++column) {
      const double std = row == column ? errors.scale_std : errors.misalignment_std;
      scale_[column][row] += std * drawn.at(draw++);
    }
  for (int axis = 0; axis < 3; ++axis) {
    drift_.emplace_back(StreamKey(seed, fmt::format("{}/drift.{}", name, axis), sequence),
                        errors.bias_instability / most_gauss_markov_allan, errors.bias_time_s, step_s);
    walk_.emplace_back(StreamKey(seed, fmt::format("{}/walk.{}", name, axis), sequence), errors.bias_walk,
                       step_s);
  }
}

TriadSample Triad::measure(const dvec3& truth, int64_t sample) {
  TriadSample out;
  const dvec3 scaled = scale_ * truth;
  for (int axis = 0; axis < 3; ++axis) {
    const auto i = static_cast<size_t>(axis);
    out.bias[axis] = constant_[axis] + drift_[i].at(sample) + walk_[i].at(sample);
    double value = scaled[axis] + out.bias[axis];
    if (noise_ > 0.0) value += noise_ * white_.at(3 * static_cast<uint64_t>(sample) + i);
    if (errors_.range > 0.0) value = std::clamp(value, -errors_.range, errors_.range);
    if (errors_.resolution > 0.0) value = errors_.resolution * std::round(value / errors_.resolution);
    out.measured[axis] = value;
  }
  return out;
}

}  // namespace greatx::navigation
