// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/watch.h"

namespace greatx::apps {

/// As long as this lives, long work of this thread (a search for paths) ends with Interrupted after Ctrl-C or
/// SIGTERM, if install_interrupt_handler() was called, and tells how far it is like Progress, in its place on
/// stderr: a bar and the time left, from the second second on.
class TerminalWatch : public Watch {
 public:
  explicit TerminalWatch(bool quiet);
  bool look(const WorkState& state) noexcept override;
  void stage_ended() noexcept override;

 private:
  bool visible_, drawn_ = false;
  std::chrono::steady_clock::time_point last_;
  WatchScope scope_;
};

}  // namespace greatx::apps
