// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Shows the progress of runs on stderr, and notices interruptions by Ctrl-C or SIGTERM.
#pragma once

#include <chrono>
#include <cstdint>
#include <string>

namespace greatx::apps {

/// Names where progress is shown.
enum class ProgressPlace {
  nowhere,
  terminal,  ///< a line on stderr that is drawn again
  log,       ///< stderr is no terminal: a message at every log_interval()
};
/// Returns the place for a command that is `quiet` or not.
ProgressPlace progress_place(bool quiet);
/// Returns the time between two messages of progress in a log: GREATX_PROGRESS_S seconds, else 30 s. Throws
/// UserError if that is not a number above 0.
std::chrono::duration<double> log_interval();

/// Shows the rate in units per second and the time left, on a terminal with a bar.
class Progress {
 public:
  /// If `unit` is empty, the line shows the percentage that is done instead of a count and a rate.
  Progress(std::string what, int64_t total, bool quiet, std::string unit = "ticks");
  ~Progress();
  void update(int64_t done);

 private:
  std::string what_, unit_;
  int64_t total_, first_ = -1;
  ProgressPlace place_;
  std::chrono::steady_clock::time_point begin_, last_;
};

/// Returns a line such as "\rsearch [####      ] about 41 %, 0:32 min left". `share` is the part of the work
/// that is done after `seconds`. If it is unknown, < 0, the line shows the elapsed time.
std::string progress_line(const std::string& what, double share, double seconds);

/// Returns the same as a message for a log, such as "search: about 41 %, 0:32 min left".
std::string progress_message(const std::string& what, double share, double seconds);

/// Returns true after Ctrl-C or SIGTERM, if the handler is installed. Long work then stops after the current
/// tick.
bool interrupted();
/// Makes interrupted() true as a signal does; a handler of another signal may call it.
void interrupt() noexcept;
/// Installs the handler of the first Ctrl-C or SIGTERM; a second one ends the program at once.
void install_interrupt_handler();

}  // namespace greatx::apps
