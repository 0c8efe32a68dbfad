// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace greatx::sim {

/// Holds the time of one pass on the device, or of one activity of the host.
struct TimeRow {
  /// Place of the sensor that it belongs to among those of the run; `shared`: it serves several.
  static constexpr uint32_t shared = ~0u;
  std::string name;  ///< of the pass's scope; of the host: "record", "collect", "compare", "wait"
  uint32_t sensor = shared;
  bool on_device = false;
  uint32_t count = 1;  ///< scopes of this name in the tick
  double milliseconds = 0.0;
};

/// Holds the times of one tick. Device and host work at the same time on neighbouring ticks, so the rows may
/// add up to more than the wall time of a tick. "wait" is the time that the host waits for the device.
struct TickTimes {
  std::vector<TimeRow> rows;     ///< in the order of the work
  double simulated_ms = 0.0;     ///< simulated time since the due tick before it; of the first: to the next
  double start_ms = 0.0;         ///< wall time of Simulator::start() before the tick: searches, catching up
  bool device_is_a_cpu = false;  ///< the device works on the host's cores
};

/// Returns the bytes that the times take.
inline uint64_t bytes_of(const TickTimes& times) {
  uint64_t bytes = sizeof(TickTimes) + sizeof(TimeRow) * times.rows.capacity();
  for (const TimeRow& row : times.rows) bytes += row.name.capacity();
  return bytes;
}

}  // namespace greatx::sim
