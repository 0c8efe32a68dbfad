// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <sys/resource.h>

namespace greatx::sim {

/// Measures wall time and the time of all threads of the process from its construction on.
class Stopwatch {
 public:
  double wall_ms() const {
    return std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - begin_).count();
  }
  double cpu_ms() const { return process_ms() - cpu_begin_ms_; }

 private:
  static double process_ms() {
    rusage usage{};
    getrusage(RUSAGE_SELF, &usage);
    const auto of = [](const timeval& t) { return 1e3 * double(t.tv_sec) + 1e-3 * double(t.tv_usec); };
    return of(usage.ru_utime) + of(usage.ru_stime);
  }

  const std::chrono::steady_clock::time_point begin_ = std::chrono::steady_clock::now();
  const double cpu_begin_ms_ = process_ms();
};

}  // namespace greatx::sim
