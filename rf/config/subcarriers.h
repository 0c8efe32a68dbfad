// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Computes the number of subcarriers in a bandwidth. It is a header alone, because the scenario's parser
// needs the function and no device.
#pragma once

#include <cmath>
#include <cstdint>
#include <limits>

#include "core/error.h"

namespace greatx::rf {

/// Returns the number of subcarriers of `spacing_hz` that lie wholly within `bandwidth_hz`:
/// floor(bandwidth/spacing). A quotient within 1e-9 of a whole number is that number (20 MHz / 15 kHz: 1333;
/// 0.3 / 0.1: 3). There are no guard bands: give the occupied bandwidth. Both arguments must be finite and
/// above 0, the spacing at most the bandwidth, and the result below 2^32.
inline uint32_t subcarrier_count(double bandwidth_hz, double spacing_hz) {
  GREATX_CHECK(std::isfinite(bandwidth_hz) && spacing_hz > 0.0 && std::isfinite(spacing_hz),
               "subcarriers of {} Hz in {} Hz", spacing_hz, bandwidth_hz);
  const double quotient = bandwidth_hz / spacing_hz, nearest = std::nearbyint(quotient);
  const double count = std::abs(quotient - nearest) <= 1e-9 ? nearest : std::floor(quotient);
  GREATX_CHECK(count >= 1.0 && count <= std::numeric_limits<uint32_t>::max(),
               "{} subcarriers of {} Hz in {} Hz", count, spacing_hz, bandwidth_hz);
  return static_cast<uint32_t>(count);
}

}  // namespace greatx::rf
