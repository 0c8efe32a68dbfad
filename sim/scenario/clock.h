// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Defines the integer clock. A tick is 1/tick_rate. Seconds are computed from the tick and never accumulated.
#pragma once

#include <cstdint>

#include "sim/scenario/rational.h"

namespace greatx::sim {

class Clock {
 public:
  explicit Clock(Rational tick_rate_hz) : rate_(tick_rate_hz) {}
  Rational tick_rate_hz() const { return rate_; }
  double seconds(int64_t tick) const;
  /// Returns the exact time rounded to the nearest nanosecond, half up.
  int64_t nanoseconds(int64_t tick) const;

 private:
  Rational rate_;
};

/// Represents the ticks at which a sensor of rational rate fires: sample k at tick round(k * tick_rate /
/// rate), half up, in exact integers.
class SampleTimes {
 public:
  SampleTimes(Rational tick_rate_hz, Rational rate_hz);
  int64_t tick_of(int64_t sample) const;
  /// Returns the sample that fires at `tick`; -1: none.
  int64_t sample_at(int64_t tick) const;
  /// Returns the first sample that fires at or after `tick`.
  int64_t first_at_or_after(int64_t tick) const;

 private:
  Rational ticks_per_sample_;
};

}  // namespace greatx::sim
