// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>
#include <cstdint>

namespace greatx {

/// Describes the band of a channel: its carrier and the frequencies between which its subcarriers lie.
struct Band {
  double carrier_hz = 0.0, lowest_hz = 0.0, highest_hz = 0.0;

  double width_hz() const { return highest_hz - lowest_hz; }
  /// Returns sample i of `steps` + 1 samples: sample 0 is the lowest frequency, the last one the highest.
  double sample_hz(uint32_t i, uint32_t steps) const {
    return i == steps ? highest_hz : lowest_hz + width_hz() * i / steps;
  }
};

/// Returns the larger of `least` and the number of steps of at most `step` that fill `range`, but at most
/// `most`.
inline uint32_t steps_over(double range, double step, uint32_t least, uint32_t most) {
  const double steps = std::ceil(range / step);
  return steps >= most ? most : steps <= least ? least : static_cast<uint32_t>(steps);
}

}  // namespace greatx
