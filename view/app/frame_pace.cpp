// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "view/app/frame_pace.h"

#include <algorithm>
#include <ctime>
#include <thread>

namespace greatx::view {

namespace {

/// Of all cores, for the window. A run that is slowed down by 15 % leaves it so much.
constexpr double window_share = 0.13;
/// The window's own drawing runs on the driver's threads. It takes about a fifth of the rest (measured in a
/// window of 1280 x 720 with lavapipe).
constexpr double drawing_factor = 1.2;
constexpr double smoothing = 0.2;

double thread_cpu_s() {
  timespec time{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &time);
  return static_cast<double>(time.tv_sec) + 1e-9 * static_cast<double>(time.tv_nsec);
}

}  // namespace

void FramePace::frame_begins() { began_cpu_s_ = thread_cpu_s(); }

void FramePace::frame_ended(double picture_ms) {
  const double cost_s = drawing_factor * (thread_cpu_s() - began_cpu_s_ + 1e-3 * picture_ms);
  cost_s_ += (cost_s_ == 0.0 ? 1.0 : smoothing) * (cost_s - cost_s_);
  const unsigned cores = std::max(1u, std::thread::hardware_concurrency());
  interval_s_ = cost_s_ / (window_share * cores);
  next_ =
      Clock::now() + std::chrono::duration_cast<Clock::duration>(std::chrono::duration<double>(interval_s_));
}

}  // namespace greatx::view
