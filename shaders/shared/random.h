// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Makes counter-based random numbers. Each is a pure function of (seed, sensor, tick, element, dimension), so
// that nothing depends on threads, on order, or on which other sensors are on. Philox4x32-10: J. Salmon et
// al., "Parallel Random Numbers: As Easy as 1, 2, 3", SC'11, section 4.2 and table 2.
#ifndef GREATX_SHADERS_SHARED_RANDOM_H
#define GREATX_SHADERS_SHARED_RANDOM_H
#include "glsl.h"

GREATX_SHARED_BEGIN

/// Returns the high and low 32 bits of a * b.
GREATX_FUNCTION uvec2 multiply_wide(uint a, uint b) {
  uint64_t product = uint64_t(a) * uint64_t(b);
  return uvec2(uint(product >> 32), uint(product));
}

/// Returns 128 random bits for a 128-bit counter and a 64-bit key.
GREATX_FUNCTION uvec4 philox4x32(uvec4 counter, uvec2 key) {
  for (int round = 0; round < 10; ++round) {
    uvec2 p0 = multiply_wide(0xD2511F53u, counter.x);
    uvec2 p1 = multiply_wide(0xCD9E8D57u, counter.z);
    counter = uvec4(p1.x ^ counter.y ^ key.x, p1.y, p0.x ^ counter.w ^ key.y, p0.y);
    key = uvec2(key.x + 0x9E3779B9u, key.y + 0xBB67AE85u);
  }
  return counter;
}

/// Returns four random words for dimension block `dimension` of `element` of `sensor` at `tick`.
GREATX_FUNCTION uvec4 random_bits(uint seed, uint sensor, uint tick, uint element, uint dimension) {
  return philox4x32(uvec4(tick, element, dimension, 0u), uvec2(seed, sensor));
}

/// Returns a uniform number in [0, 1) with 24 bits.
GREATX_FUNCTION float unit_float(uint bits) { return float(bits >> 8) * (1.0f / 16777216.0f); }

GREATX_SHARED_END
#endif
