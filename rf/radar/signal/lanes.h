// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Helps to vectorize loops. GREATX_LANES before a function compiles the function once for processors with
// eight lanes and once for those with four, and selects one at run time. The bits are the same, because no
// operation is contracted or reordered. The functions here have no branches, so that the compiler can
// vectorize loops over them.
#pragma once

#include <bit>
#include <cmath>
#include <complex>
#include <cstdint>

#include "core/phase.h"

// Sanitizers instrument the function that selects, which runs before they do.
#if defined(__x86_64__) && defined(__GNUC__) && !defined(__clang__) && !defined(__SANITIZE_ADDRESS__) && \
    !defined(__SANITIZE_THREAD__)
#define GREATX_LANES [[gnu::target_clones("avx2", "default")]]
#else
#define GREATX_LANES
#endif

namespace greatx::rf {

/// Holds four numbers that are processed as one.
struct Four {
  using Lanes [[gnu::vector_size(16)]] = float;
  Lanes lane{};
  Four() = default;
  Four(float all) : lane{all, all, all, all} {}
  explicit Four(Lanes of) : lane(of) {}
  static Four at(const float* four) {
    using Stored [[gnu::vector_size(16), gnu::aligned(4), gnu::may_alias]] = float;
    return Four(*reinterpret_cast<const Stored*>(four));
  }
  Four& operator+=(const Four& o) { return lane += o.lane, *this; }
  Four& operator-=(const Four& o) { return lane -= o.lane, *this; }
  Four& operator*=(const Four& o) { return lane *= o.lane, *this; }
  friend Four operator+(const Four& a, const Four& b) { return Four(a.lane + b.lane); }
  friend Four operator-(const Four& a, const Four& b) { return Four(a.lane - b.lane); }
  friend Four operator*(const Four& a, const Four& b) { return Four(a.lane * b.lane); }
  friend Four operator-(const Four& a) { return Four(-a.lane); }
};

/// Transposes a 4 x 4 matrix whose rows are a, b, c, d.
inline void transpose(Four& a, Four& b, Four& c, Four& d) {
  const Four::Lanes ab = {a.lane[0], b.lane[0], a.lane[1], b.lane[1]},
                    cd = {c.lane[0], d.lane[0], c.lane[1], d.lane[1]},
                    ab2 = {a.lane[2], b.lane[2], a.lane[3], b.lane[3]},
                    cd2 = {c.lane[2], d.lane[2], c.lane[3], d.lane[3]};
  a.lane = Four::Lanes{ab[0], ab[1], cd[0], cd[1]};
  b.lane = Four::Lanes{ab[2], ab[3], cd[2], cd[3]};
  c.lane = Four::Lanes{ab2[0], ab2[1], cd2[0], cd2[1]};
  d.lane = Four::Lanes{ab2[2], ab2[3], cd2[2], cd2[3]};
}

/// Returns the nearest whole number, with ties to even, for |value| < 2^51 (double) or 2^22 (float).
inline double nearest(double value) { return (value + 0x1.8p52) - 0x1.8p52; }
inline float nearest(float value) { return (value + 0x1.8p23f) - 0x1.8p23f; }

/// Computes cos and sin of 2 pi `turns` for |turns| <= 2^20, to 1.2e-7, by polynomials over an eighth of a
/// turn on each side (S. Moshier, Cephes 2.2, sinf.c and cosf.c).
inline void cos_sin_of_turns(float turns, float& cosine, float& sine) {
  const float quarter = nearest(turns * 4.0f);
  const float x = (turns - quarter * 0.25f) * 6.28318530717958647692f, xx = x * x;
  const float s = x + x * xx * (-1.6666654611e-1f + xx * (8.3321608736e-3f + xx * -1.9515295891e-4f));
  const float c =
      1.0f - 0.5f * xx +
      xx * xx * (4.166664568298827e-2f + xx * (-1.388731625493765e-3f + xx * 2.443315711809948e-5f));
  const uint32_t q = static_cast<uint32_t>(static_cast<int32_t>(quarter));
  const uint32_t swap = 0u - (q & 1u);  // all ones if sine and cosine change places
  const uint32_t cosine_bits = (std::bit_cast<uint32_t>(c) & ~swap) | (std::bit_cast<uint32_t>(s) & swap);
  const uint32_t sine_bits = (std::bit_cast<uint32_t>(s) & ~swap) | (std::bit_cast<uint32_t>(c) & swap);
  cosine = std::bit_cast<float>(cosine_bits ^ (((q + 1u) & 2u) << 30));
  sine = std::bit_cast<float>(sine_bits ^ ((q & 2u) << 30));
}

/// Returns the natural logarithm of a normal number above 0, to 2e-7 (S. Moshier, Cephes 2.2, logf.c).
inline float natural_log(float value) {
  uint32_t bits = std::bit_cast<uint32_t>(value);
  // value = 2^exponent * fraction with the fraction in [sqrt(1/2), sqrt(2)).
  const int32_t exponent = static_cast<int32_t>(bits - 0x3f3504f3u) >> 23;
  bits -= static_cast<uint32_t>(exponent) << 23;
  const float x = std::bit_cast<float>(bits) - 1.0f, xx = x * x, e = static_cast<float>(exponent);
  float p = 7.0376836292e-2f;
  p = p * x - 1.1514610310e-1f;
  p = p * x + 1.1676998740e-1f;
  p = p * x - 1.2420140846e-1f;
  p = p * x + 1.4249322787e-1f;
  p = p * x - 1.6668057665e-1f;
  p = p * x + 2.0000714765e-1f;
  p = p * x - 2.4999993993e-1f;
  p = p * x + 3.3333331174e-1f;
  return (x * xx * p - 2.12194440e-4f * e - 0.5f * xx) + x + 0.693359375f * e;
}

/// Computes a complex normal number of variance 1 from a uniform one in (0, 1] and an angle in turns
/// (Box-Muller).
inline void complex_normal(float uniform, float turns, float& re, float& im) {
  const float radius = std::sqrt(-natural_log(uniform));
  float cosine, sine;
  cos_sin_of_turns(turns, cosine, sine);
  re = radius * cosine;
  im = radius * sine;
}

/// Returns a sample whose phase grows by `turns`.
inline std::complex<float> turned_sample(std::complex<float> sample, float turns) {
  float cosine, sine;
  cos_sin_of_turns(turns, cosine, sine);
  return plain_product(sample, std::complex<float>(cosine, sine));
}

}  // namespace greatx::rf
