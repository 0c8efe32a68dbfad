// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Shows the progress of long work and lets Ctrl-C interrupt it.
#pragma once

#include "apps/console/progress.h"
#include "core/watch.h"

namespace greatx::apps {

/// As long as this lives, it watches long work of its thread, such as a search for paths. If
/// install_interrupt_handler() was called, the work ends with Interrupted after Ctrl-C or SIGTERM. Work that
/// takes more than a second shows a line on stderr like that of Progress: a bar and the time left. Without a
/// terminal it says so at every log_interval().
class TerminalWatch : public Watch {
 public:
  explicit TerminalWatch(bool quiet);
  bool look(const WorkState& state) noexcept override;
  void stage_ended() noexcept override;

 private:
  ProgressPlace place_;
  bool drawn_ = false;
  std::chrono::duration<double> interval_;
  std::chrono::steady_clock::time_point last_;
  WatchScope scope_;
};

}  // namespace greatx::apps
