// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "rf/radar/signal/codes.h"

#include <bit>

#include "core/error.h"

namespace greatx::rf {
namespace {

/// Feedback taps of registers with 5 to 16 stages: bit k - 1 stands for x^k of a primitive polynomial.
constexpr uint32_t register_taps[] = {0x14,  0x30,  0x60,   0xB8,   0x110,  0x240,
                                      0x500, 0xE08, 0x1C80, 0x3802, 0x6000, 0xD008};

std::vector<float> m_sequence(uint32_t chips) {
  const uint32_t stages = static_cast<uint32_t>(std::bit_width(chips));
  const uint32_t taps = register_taps[stages - 5];
  std::vector<float> result;
  uint32_t state = 1;
  for (uint32_t i = 0; i < chips; ++i) {
    result.push_back((state & 1u) != 0 ? -1.0f : 1.0f);
    const uint32_t fed = static_cast<uint32_t>(std::popcount(state & taps)) & 1u;
    state = ((state << 1) | fed) & chips;
  }
  return result;
}

/// An element a + b x of GF(p)[x]/(x^2 - t x + n).
struct Element {
  uint64_t a, b;
};

/// Holds a field GF(p^2) as polynomials in a root x of x^2 - t x + n.
struct QuadraticField {
  uint64_t p, t, n;
  Element product(Element u, Element v) const {
    // x^2 = t x - n.
    const uint64_t high = u.b * v.b % p;
    return {(u.a * v.a + high * (p - n)) % p, (u.a * v.b % p + u.b * v.a % p + high * t) % p};
  }
  Element power(Element base, uint64_t exponent) const {
    Element result{1, 0};
    for (; exponent > 0; exponent >>= 1) {
      if (exponent & 1) result = product(result, base);
      base = product(base, base);
    }
    return result;
  }
  /// Says whether x has the order p^2 - 1.
  bool primitive() const {
    const uint64_t order = p * p - 1;
    const auto is_one = [&](uint64_t exponent) {
      const Element e = power({0, 1}, exponent);
      return e.a == 1 && e.b == 0;
    };
    if (!is_one(order)) return false;
    uint64_t left = order;
    for (uint64_t factor = 2; factor * factor <= left; ++factor) {
      if (left % factor != 0) continue;
      while (left % factor == 0) left /= factor;
      if (is_one(order / factor)) return false;
    }
    return left == 1 || !is_one(order / left);
  }
};

std::vector<float> almost_perfect(uint32_t chips) {
  const uint64_t p = chips / 2 - 1;
  QuadraticField field{p, 1, 2};
  while (!field.primitive()) {
    if (++field.n == p) field.n = 2, ++field.t;
    GREATX_CHECK(field.t < p, "no primitive polynomial of degree 2 over GF({})", p);
  }
  std::vector<bool> square(p, false);
  for (uint64_t v = 1; v < p; ++v) square[v * v % p] = true;
  // The trace of x^i follows the recurrence of the polynomial: s_0 = 2, s_1 = t.
  std::vector<float> result;
  uint64_t now = 2 % p, next = field.t;
  for (uint32_t i = 0; i < chips; ++i) {
    result.push_back(now == 0 || square[now] ? 1.0f : -1.0f);
    const uint64_t after = (field.t * next + (p - field.n) * now) % p;
    now = next, next = after;
  }
  return result;
}

}  // namespace

std::vector<float> code_chips(RadarCode code, uint32_t chips) {
  GREATX_CHECK(code_exists(code, chips), "a code of {} chips", chips);
  return code == RadarCode::m_sequence ? m_sequence(chips) : almost_perfect(chips);
}

}  // namespace greatx::rf
