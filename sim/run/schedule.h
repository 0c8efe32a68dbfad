// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Which sensors fire at which tick.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "sim/scenario/clock.h"

namespace greatx::sim {

/// A sensor that is due, and which of its samples this is.
struct Due {
  uint32_t sensor = 0;
  int64_t sample = 0;
};

class Schedule {
 public:
  explicit Schedule(Rational tick_rate_hz) : tick_rate_hz_(tick_rate_hz) {}
  /// The next sensor index fires at `rate_hz`; none: whenever a sensor with a rate does.
  void add(std::optional<Rational> rate_hz);

  /// Sensors due at `tick`, by index. `before`: the number of ticks of the sequence before this one at which
  /// something was due, which is the sample of a sensor without a rate.
  std::vector<Due> due(int64_t tick, int64_t before) const;
  /// The first tick at or after `tick` at which something is due; `end` if there is none before it.
  int64_t next(int64_t tick, int64_t end) const;
  /// The last tick before `tick` at which something was due; -1: none.
  int64_t previous(int64_t tick) const;

 private:
  Rational tick_rate_hz_;
  std::vector<std::optional<SampleTimes>> times_;  ///< none: it fires whenever another one does
};

}  // namespace greatx::sim
