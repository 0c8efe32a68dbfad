// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "shaders/shared/random.h"

namespace greatx {

/// Represents a stream of counter-based random numbers on the host (shaders/shared/random.h). The n-th draw
/// of a stream depends on (seed, stream, sequence, n) only.
class RandomStream {
 public:
  RandomStream(uint64_t seed, uint32_t stream, uint32_t sequence = 0)
      : key_(static_cast<uint32_t>(seed), static_cast<uint32_t>(seed >> 32)),
        stream_(stream),
        sequence_(sequence) {}

  uint64_t bits() {
    const glm::uvec4 word = shared::philox4x32(glm::uvec4(draw_++, stream_, sequence_, 0x67747821u), key_);
    return (static_cast<uint64_t>(word.y) << 32) | word.x;
  }
  /// Returns a uniform number in [0, 1) with 53 bits.
  double uniform() { return static_cast<double>(bits() >> 11) * 0x1.0p-53; }
  double uniform(double low, double high) { return low + (high - low) * uniform(); }
  /// Returns a uniform integer in [0, count).
  uint32_t below(uint32_t count) { return static_cast<uint32_t>(uniform() * count); }

 private:
  glm::uvec2 key_;
  uint32_t stream_;
  uint32_t sequence_;
  uint32_t draw_ = 0;
};

}  // namespace greatx
