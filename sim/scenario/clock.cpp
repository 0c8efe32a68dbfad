// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "sim/scenario/clock.h"

#include <limits>

#include "core/error.h"

namespace greatx::sim {
namespace {

__extension__ typedef __int128 int128;

/// Returns floor(a / b), b > 0.
int128 floor_divide(int128 a, int128 b) { return a / b - (a % b < 0 ? 1 : 0); }

int64_t narrow(int128 value, const char* what) {
  GREATX_CHECK(value >= std::numeric_limits<int64_t>::min() && value <= std::numeric_limits<int64_t>::max(),
               "{} overflows 64 bits", what);
  return static_cast<int64_t>(value);
}

/// Returns round(a / b), half up. b is above 0 and below 2^64, so that twice the remainder fits.
int128 round_divide(int128 a, int128 b) {
  const int128 below = floor_divide(a, b);
  return below + (2 * (a - below * b) >= b ? 1 : 0);
}

Rational ratio_of_rates(const Rational& tick_rate_hz, const Rational& rate_hz) {
  const auto ratio = quotient(tick_rate_hz, rate_hz);
  if (!ratio)
    throw_user_error(
        "expected rates whose ratio fits 64-bit integers, found tick rate {} Hz and sensor rate {} Hz",
        tick_rate_hz.str(), rate_hz.str());
  GREATX_CHECK(!less(tick_rate_hz, rate_hz), "sensor rate {} Hz above the tick rate {} Hz", rate_hz.str(),
               tick_rate_hz.str());
  return *ratio;
}

}  // namespace

double Clock::seconds(int64_t tick) const {
  const int128 numerator = static_cast<int128>(tick) * rate_.denominator;
  constexpr int128 exact = static_cast<int128>(1) << 53;
  // Both sides are exact in fp64, so that there is one rounding, and tick n of n Hz is exactly 1 s.
  if (numerator <= exact && numerator >= -exact && rate_.numerator <= exact)
    return static_cast<double>(static_cast<int64_t>(numerator)) / static_cast<double>(rate_.numerator);
  const int128 whole = floor_divide(numerator, rate_.numerator);
  const int128 rest = numerator - whole * rate_.numerator;
  return static_cast<double>(whole) + static_cast<double>(rest) / static_cast<double>(rate_.numerator);
}

int64_t Clock::nanoseconds(int64_t tick) const {
  const int128 numerator = static_cast<int128>(tick) * rate_.denominator;
  const int128 whole = floor_divide(numerator, rate_.numerator);
  const int128 rest = numerator - whole * rate_.numerator;
  constexpr int128 billion = 1'000'000'000;
  narrow(whole, "time in seconds");  // keeps the product below within 128 bits
  return narrow(whole * billion + round_divide(rest * billion, rate_.numerator), "time in nanoseconds");
}

SampleTimes::SampleTimes(Rational tick_rate_hz, Rational rate_hz)
    : ticks_per_sample_(ratio_of_rates(tick_rate_hz, rate_hz)) {}

int64_t SampleTimes::tick_of(int64_t sample) const {
  GREATX_CHECK(sample >= 0, "sample {}", sample);
  return narrow(
      round_divide(static_cast<int128>(sample) * ticks_per_sample_.numerator, ticks_per_sample_.denominator),
      "tick of a sample");
}

int64_t SampleTimes::sample_at(int64_t tick) const {
  if (tick < 0) return -1;
  // A sample lasts one tick or more, so samples fire at distinct ticks. Only the last sample not after the
  // tick and the one that follows can round to it.
  const int64_t sample = first_at_or_after(tick);
  return tick_of(sample) == tick ? sample : -1;
}

int64_t SampleTimes::first_at_or_after(int64_t tick) const {
  if (tick <= 0) return 0;
  const int64_t before = narrow(
      floor_divide(static_cast<int128>(tick) * ticks_per_sample_.denominator, ticks_per_sample_.numerator),
      "sample");
  return tick_of(before) >= tick ? before : before + 1;
}

}  // namespace greatx::sim
