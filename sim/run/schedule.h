// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Computes which sensors fire at which tick.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "sim/scenario/clock.h"

namespace greatx::sim {

/// Describes a sensor that is due, and the number of the sample that it delivers.
struct Due {
  uint32_t sensor = 0;
  int64_t sample = 0;
};

class Schedule {
 public:
  explicit Schedule(Rational tick_rate_hz) : tick_rate_hz_(tick_rate_hz) {}
  /// Adds a sensor, with the next index, that fires at `rate_hz`; none: it fires whenever a sensor with a
  /// rate does.
  void add(std::optional<Rational> rate_hz);

  /// Returns the sensors due at `tick`, by index. `before` is the number of earlier ticks of the sequence at
  /// which something was due; it is the sample number of a sensor without a rate.
  std::vector<Due> due(int64_t tick, int64_t before) const;
  /// Returns the first tick at or after `tick` at which something is due, or `end` if there is none before
  /// `end`.
  int64_t next(int64_t tick, int64_t end) const;
  /// Returns the last tick before `tick` at which something was due; -1: none.
  int64_t previous(int64_t tick) const;
  /// Returns the last tick at or before `tick` at which `sensor` was due; -1: none.
  int64_t last_of(uint32_t sensor, int64_t tick) const;

 private:
  Rational tick_rate_hz_;
  std::vector<std::optional<SampleTimes>> times_;  ///< none: the sensor fires whenever another one does
};

}  // namespace greatx::sim
