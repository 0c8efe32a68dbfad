// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Answers why a tick takes long: the times of the last ticks by pass and by sensor.
#pragma once

#include <cstdint>
#include <deque>
#include <memory>
#include <string>
#include <vector>

#include "view/run/run.h"

namespace greatx::view {

/// Holds what is known of one pass on the device, or of one activity of the host, over the last ticks.
struct TimeLine {
  /// Of a pass ("visibility", "radar echoes"), or what the host does: "set-up" before the passes, "results"
  /// after them, "look ahead", "consistency check".
  std::string name;
  size_t part = 0;  ///< into TimeHistory::parts()
  bool on_device = false;
  uint32_t count = 0;      ///< scopes in the present tick; 0: it did not run
  size_t ticks = 0;        ///< of the last ones in which it ran
  double now_ms = 0.0;     ///< in the present tick
  double median_ms = 0.0;  ///< of the ticks in which it ran
  double mean_ms = 0.0;    ///< over all of the last ticks
};

/// Holds what a sensor takes, or what serves several sensors.
struct TimePart {
  std::string name;                    ///< of the sensor
  double now_ms = 0.0, mean_ms = 0.0;  ///< as those of TimeLine; device and host together
};

/// Holds one of the last ticks.
struct TimedTick {
  uint32_t sequence = 0;
  int64_t tick = 0;
  double start_ms = 0.0;        ///< wall time of the start of the sequence before it
  double wall_ms = 0.0;         ///< that the tick took to simulate or to read, without start_ms
  double real_ms = 0.0;         ///< simulated time since the due tick before it; 0: unknown
  std::vector<double> part_ms;  ///< [parts]
};

/// Keeps the times of the last ticks that were shown. "Work" is the time of all passes and of all activities
/// of the host, without waiting. Device and host work at the same time, so the work of a tick may be more
/// than its wall time.
class TimeHistory {
 public:
  static constexpr size_t most_ticks = 200;

  /// Takes a tick as the present one. A tick that is shown again is not counted again.
  void add(const ShownTick& tick, const std::vector<SensorSpec>& sensors);
  /// Sums up what add() has taken. The functions below tell of the ticks until the last sum.
  void sum_up();

  const std::vector<TimePart>& parts() const { return parts_; }
  /// The lines, by mean time, longest first. A data set has none.
  const std::vector<TimeLine>& lines() const { return lines_; }
  /// The ticks, oldest first.
  const std::vector<TimedTick>& ticks() const { return ticks_; }
  /// Place of the present tick in ticks().
  size_t present() const { return present_; }
  double mean_work_ms() const { return mean_work_ms_; }
  double mean_wait_ms() const { return mean_wait_ms_; }  ///< of the host for the device
  double mean_wall_ms() const { return mean_wall_ms_; }
  double median_wall_ms() const { return median_wall_ms_; }
  double mean_real_ms() const { return mean_real_ms_; }  ///< simulated time of a tick; 0: unknown
  bool device_is_a_cpu() const { return device_is_a_cpu_; }
  /// Says in words what takes most of a tick, and whether the run keeps up with real time.
  std::string answer() const;

 private:
  struct Kept {
    uint32_t sequence = 0;
    int64_t tick = 0;
    double wall_ms = 0.0;
    std::shared_ptr<const sim::TickTimes> times;
  };
  void add_rows(size_t tick, std::vector<std::vector<double>>& samples);
  size_t part_of(uint32_t sensor);
  size_t line_of(const sim::TimeRow& row);

  std::vector<std::string> names_;  ///< [sensor]
  std::deque<Kept> kept_;
  bool changed_ = false;
  size_t present_ = 0;
  std::vector<uint32_t> part_sensors_;  ///< [parts_]
  std::vector<TimePart> parts_;
  std::vector<TimeLine> lines_;
  std::vector<TimedTick> ticks_;
  double mean_work_ms_ = 0.0, mean_wait_ms_ = 0.0, mean_wall_ms_ = 0.0, median_wall_ms_ = 0.0,
         mean_real_ms_ = 0.0;
  bool device_is_a_cpu_ = false;
};

/// Returns a time with its unit and two to three digits: "0.42 ms", "7.1 ms", "52 ms".
std::string milliseconds_text(double milliseconds);

}  // namespace greatx::view
