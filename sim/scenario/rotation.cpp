// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "sim/scenario/rotation.h"

#include <cmath>

#include "core/error.h"

namespace greatx::sim {

namespace {

__extension__ typedef __int128 int128;

Rational ratio(const Rational& rate_hz, const Rational& tick_rate_hz) {
  const auto found = quotient(rate_hz, tick_rate_hz);
  GREATX_CHECK(found.has_value(), "{} turns a second at {} ticks a second", rate_hz.str(),
               tick_rate_hz.str());
  return *found;
}

double fraction(double turns) {
  const double rest = turns - std::floor(turns);
  return rest < 1.0 ? rest : 0.0;  // a value just below 0 rounds to 1
}

}  // namespace

Rotation::Rotation(const Rational& tick_rate_hz, const TurnRate& rate, double start_turns)
    : clock_(tick_rate_hz),
      rate_(rate),
      turns_per_tick_(ratio(rate.hz, tick_rate_hz)),
      start_turns_(start_turns) {}

double Rotation::turns(double time_s) const {
  constexpr double most_ticks = 9e18;
  const double ticks = time_s * clock_.tick_rate_hz().value();
  GREATX_CHECK(std::abs(ticks) < most_ticks, "time {} s", time_s);
  const int64_t tick = std::llround(ticks);
  // After `period` ticks the share of a turn repeats.
  const int64_t period = turns_per_tick_.denominator;
  const int128 rest = static_cast<int128>(tick % period) * (turns_per_tick_.numerator % period) % period;
  const double at_tick = static_cast<double>(static_cast<int64_t>(rest)) / static_cast<double>(period);
  const double since_tick = rate_.hz.value() * (time_s - clock_.seconds(tick));
  const double turned = at_tick + since_tick;
  return fraction(start_turns_ + (rate_.negative ? -turned : turned));
}

}  // namespace greatx::sim
