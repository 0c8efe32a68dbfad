// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Where a run gets its ticks from: the simulator or a data set. All calls come from the run's thread.
#pragma once

#include <compare>
#include <cstdint>
#include <functional>
#include <memory>
#include <string>

#include "io/dataset/dataset_format.h"
#include "view/run/run.h"

namespace greatx::view {

/// Names a tick of a run.
struct TickAt {
  uint32_t sequence = 0;
  int64_t tick = 0;
  friend auto operator<=>(const TickAt&, const TickAt&) = default;
};

class TickSource {
 public:
  virtual ~TickSource() = default;
  virtual std::shared_ptr<const io::DatasetInfo> info() const = 0;
  /// Returns the first tick at or after `tick` at which a sensor is due; -1: none.
  virtual int64_t next(uint32_t sequence, int64_t tick) const = 0;
  /// Returns the last tick before `tick` at which a sensor is due; -1: none.
  virtual int64_t previous(uint32_t sequence, int64_t tick) const = 0;

  struct Loaded {
    std::shared_ptr<const ShownTick> tick;  ///< null: given up, because it is no longer wanted
    std::string error;                      ///< what the tick lacks; empty: nothing
    bool stops = false;                     ///< the error is worth a stop
  };
  /// Returns the tick, at which a sensor is due. `goes_on`: the next tick will be asked for next. Work of
  /// many ticks ends early when `unwanted` returns true. Throws if the tick cannot be had, or Interrupted
  /// like checkpoint(); others may be asked for then.
  virtual Loaded load(TickAt at, bool goes_on, const std::function<bool()>& unwanted) = 0;
  /// Does a small piece of work for ticks that may be asked for after `at`, or before it if `backwards`.
  /// Returns false if there is nothing left to do.
  virtual bool look_ahead(TickAt /*at*/, bool /*backwards*/) { return false; }
};

}  // namespace greatx::view
