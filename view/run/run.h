// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// The side of a run that the viewer sees: a live simulation or a recorded data set. A run works on a thread
// of its own. Every function here returns at once, so the window never waits for a scene, a search or a
// file.
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "core/record.h"
#include "io/dataset/dataset_format.h"
#include "sim/run/tick_times.h"

namespace greatx::view {

/// What a live run holds in memory.
struct RunMemory {
  uint64_t kept_bytes = 0;    ///< of the records that it keeps, to show them again
  uint64_t device_bytes = 0;  ///< of the buffers and images of this process on its devices
  /// Bytes that the process uses on the device, and may use there; 0: the driver does not say.
  uint64_t device_used_bytes = 0, device_budget_bytes = 0;
};

/// One tick as the viewer shows it. Nobody changes it once it is published.
struct ShownTick {
  uint32_t sequence = 0;
  /// The records of the sensors that were due at this tick.
  Packet packet;
  /// For each sensor the newest record at or before this tick, which may be older than the tick; null if
  /// there is none yet. [sensors]
  std::vector<std::shared_ptr<const Record>> newest;
  double simulated_ms = 0.0;                    ///< wall time that the tick took to simulate or to load
  std::shared_ptr<const sim::TickTimes> times;  ///< where the time went; null for a data set
  RunMemory memory;                             ///< when it was shown; zeros for a data set
};

/// What a run does at the moment.
struct RunStatus {
  enum class Phase : uint8_t { loading, ready, failed };
  Phase phase = Phase::loading;
  std::string activity;    ///< "loading the scene", "searching paths"; empty when idle
  double progress = -1.0;  ///< of the activity, 0 to 1; negative: unknown
  std::string error;       ///< of `failed`: the whole message, with file and line; also of a tick that failed
  bool playing = false;
  double speed = 1.0;  ///< wanted ticks of simulated time per wall time: 1 is real time, 0 as fast as it can
  double reached = 0.0;  ///< the speed of the last second
  uint32_t sequence = 0;
  int64_t tick = -1;  ///< shown; -1: none yet
};

class Run {
 public:
  virtual ~Run() = default;
  virtual RunStatus status() const = 0;
  /// Null while the run loads. Constant afterwards.
  virtual std::shared_ptr<const io::DatasetInfo> info() const = 0;
  /// The newest tick that is complete; null before the first one.
  virtual std::shared_ptr<const ShownTick> shown() const = 0;
  /// A number that changes whenever status() or shown() would return something new.
  virtual uint64_t version() const = 0;

  virtual void play(bool playing) = 0;
  virtual void set_speed(double speed) = 0;
  /// Shows the tick that is `ticks` due ticks after the one shown, or before it if negative. Pauses.
  virtual void step(int ticks) = 0;
  /// Shows the first due tick at or after `tick` of `sequence`. Goes on playing if it played.
  virtual void jump(uint32_t sequence, int64_t tick) = 0;
};

}  // namespace greatx::view
