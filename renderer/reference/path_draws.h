// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "shaders/shared/random.h"

namespace greatx::render {

/// The random numbers of one path, a pure function of (seed, pixel, sample).
class PathDraws {
 public:
  PathDraws(uint64_t seed, uint32_t pixel, uint32_t sample)
      : key_(static_cast<uint32_t>(seed), static_cast<uint32_t>(seed >> 32)),
        pixel_(pixel),
        sample_(sample) {}
  /// Returns a uniform number in (0, 1) with 32 bits.
  double next() {
    if (used_ == 4) {
      words_ = shared::philox4x32(glm::uvec4(sample_, pixel_, block_++, 0x70617468u), key_);
      used_ = 0;
    }
    return (words_[used_++] + 0.5) * 0x1.0p-32;
  }

 private:
  glm::uvec2 key_;
  uint32_t pixel_, sample_, block_ = 0;
  int used_ = 4;
  glm::uvec4 words_{0};
};

}  // namespace greatx::render
