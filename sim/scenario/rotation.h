// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "sim/scenario/clock.h"
#include "sim/scenario/rational.h"

namespace greatx::sim {

/// Describes a constant rate of turning.
struct TurnRate {
  Rational hz;            ///< the size of the rate
  bool negative = false;  ///< clockwise as seen from the axis' tip
  double value_hz() const { return negative ? -hz.value() : hz.value(); }
  friend bool operator==(const TurnRate&, const TurnRate&) = default;
};

/// Represents a constant turn about an axis, without drift. Whole turns between ticks are taken off in
/// integers before anything is rounded. From the nearest tick on, the time is a small number.
class Rotation {
 public:
  /// `start_turns` is the share at tick 0. The ratio of both rates must fit 64-bit integers (ContractError).
  Rotation(const Rational& tick_rate_hz, const TurnRate& rate, double start_turns);
  /// Returns the share of a turn, [0, 1). At a tick (time_s = Clock::seconds) it is exact but for one
  /// rounding, after any number of turns. Between ticks it is as exact as time_s is. The time is within
  /// +-9e18 ticks.
  double turns(double time_s) const;
  double rate_hz() const { return rate_.value_hz(); }  ///< right-handed about the axis

 private:
  Clock clock_;
  TurnRate rate_;
  Rational turns_per_tick_;
  double start_turns_;
};

}  // namespace greatx::sim
