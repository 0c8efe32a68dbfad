// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <cstdint>
#include <string>

namespace greatx::apps {

/// A line on stderr with a bar, the rate in `unit`s and the time left; silent when stderr is no terminal.
class Progress {
 public:
  /// `unit` empty: a share of the whole, no rate.
  Progress(std::string what, int64_t total, bool quiet, std::string unit = "ticks");
  ~Progress();
  void update(int64_t done);

 private:
  std::string what_, unit_;
  int64_t total_, first_ = -1;
  bool visible_;
  std::chrono::steady_clock::time_point begin_, last_;
};

/// "\rsearch [####      ] about 41 %, 0:32 min left": `share` of the work is done after so many seconds, < 0:
/// who knows.
std::string progress_line(const std::string& what, double share, double seconds);

/// True after Ctrl-C or SIGTERM, once installed: long work stops after the tick it is in.
bool interrupted();
void install_interrupt_handler();

}  // namespace greatx::apps
