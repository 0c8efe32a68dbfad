// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "core/watch.h"

#include <algorithm>

namespace greatx::detail {

void WatchedWork::poll() {
  constexpr std::chrono::milliseconds pause{50};
  const Clock::time_point now = Clock::now();
  if (now - looked_ < pause) return;
  WorkState state;
  if (what_ != nullptr) {
    const double total = total_.load(std::memory_order_relaxed);
    const auto done = static_cast<double>(done_.load(std::memory_order_relaxed));
    state.what = what_;
    state.share = total > 0.0 ? std::min(1.0, done / total) : -1.0;
    state.seconds = std::chrono::duration<double>(now - begun_).count();
  }
  if (!watch_.look(state)) stop_.store(true, std::memory_order_relaxed);
  looked_ = Clock::now();
}

bool WatchedWork::begin(const char* what) {
  if (what_ != nullptr) return false;
  done_ = 0;
  total_ = 0.0;
  begun_ = Clock::now();
  what_ = what;
  return true;
}

void WatchedWork::end() {
  what_ = nullptr;
  watch_.stage_ended();
}

}  // namespace greatx::detail
