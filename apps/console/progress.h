// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Shows the progress of runs on stderr, and notices interruptions by Ctrl-C or SIGTERM.
#pragma once

#include <chrono>
#include <cstdint>
#include <string>

namespace greatx::apps {

/// Shows a line on stderr with a bar, the rate in units per second and the time left. It shows nothing if
/// `quiet` is set or stderr is not a terminal.
class Progress {
 public:
  /// If `unit` is empty, the line shows the percentage that is done instead of a count and a rate.
  Progress(std::string what, int64_t total, bool quiet, std::string unit = "ticks");
  ~Progress();
  void update(int64_t done);

 private:
  std::string what_, unit_;
  int64_t total_, first_ = -1;
  bool visible_;
  std::chrono::steady_clock::time_point begin_, last_;
};

/// Returns a line such as "\rsearch [####      ] about 41 %, 0:32 min left". `share` is the part of the work
/// that is done after `seconds`. If it is unknown, < 0, the line shows the elapsed time.
std::string progress_line(const std::string& what, double share, double seconds);

/// Returns true after Ctrl-C or SIGTERM, if the handler is installed. Long work then stops after the current
/// tick.
bool interrupted();
/// Makes interrupted() true as a signal does; a handler of another signal may call it.
void interrupt() noexcept;
/// Installs the handler of the first Ctrl-C or SIGTERM; a second one ends the program at once.
void install_interrupt_handler();

}  // namespace greatx::apps
