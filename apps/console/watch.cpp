// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "apps/console/watch.h"

#include <cstdio>

#include <spdlog/spdlog.h>

namespace greatx::apps {

TerminalWatch::TerminalWatch(bool quiet)
    : place_(progress_place(quiet)),
      interval_(log_interval()),
      last_(place_ == ProgressPlace::log ? std::chrono::steady_clock::now()
                                         : std::chrono::steady_clock::time_point()),
      scope_(*this) {}

bool TerminalWatch::look(const WorkState& state) noexcept {
  if (interrupted()) return false;
  constexpr double soon_s = 1.0;
  const auto now = std::chrono::steady_clock::now();
  if (place_ == ProgressPlace::nowhere || state.what == nullptr || state.seconds < soon_s) return true;
  if (place_ == ProgressPlace::log) {
    if (now - last_ < interval_) return true;
    last_ = now;
    spdlog::info("{}", progress_message(state.what, state.share, state.seconds));
    return true;
  }
  if (drawn_ && now - last_ < std::chrono::milliseconds(200)) return true;
  last_ = now;
  drawn_ = true;
  std::fputs(progress_line(state.what, state.share, state.seconds).c_str(), stderr);
  std::fflush(stderr);
  return true;
}

void TerminalWatch::stage_ended() noexcept {
  if (!drawn_) return;
  drawn_ = false;
  std::fputs("\r\x1b[K", stderr);  // clears the line, so that the next output begins a line
  std::fflush(stderr);
}

}  // namespace greatx::apps
