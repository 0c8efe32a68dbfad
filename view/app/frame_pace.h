// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// How often the window shows a new tick of a run that cannot keep up with its speed. The run then uses all
// cores, so each frame and each picture of the scene takes its time from the run. The pace keeps what the
// window takes below a share of the cores.
#pragma once

#include <chrono>

namespace greatx::view {

class FramePace {
 public:
  using Clock = std::chrono::steady_clock;

  void frame_begins();
  /// `picture_ms`: the wall time that the newest picture of the scene took.
  void frame_ended(double picture_ms);
  /// Whether the next tick may be shown.
  bool due() const { return Clock::now() >= next_; }
  /// The least time between two ticks that are shown, s.
  double interval_s() const { return interval_s_; }

 private:
  double began_cpu_s_ = 0.0;  ///< processor time of this thread
  double cost_s_ = 0.0;       ///< processor time of a tick in the window, smoothed
  double interval_s_ = 0.0;
  Clock::time_point next_;
};

}  // namespace greatx::view
