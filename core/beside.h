// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <future>
#include <thread>
#include <utility>

#include "core/watch.h"

namespace greatx {

/// Starts work() on a thread beside the caller's. If the caller's work is watched (core/watch.h), the watch
/// may stop this thread's work, too; it lives until the thread is joined.
template <typename Work>
std::thread start_beside(Work work) {
  return std::thread([work = std::move(work), watched = detail::watched_work]() mutable {
    detail::watched_work = watched;
    work();
  });
}

/// Returns the result of work on another thread, or throws what it threw. The caller's watch is asked while
/// the result is not there yet.
template <typename Result>
Result wait_watched(std::future<Result>& result) {
  while (result.wait_for(std::chrono::milliseconds(20)) != std::future_status::ready) checkpoint();
  return result.get();
}

}  // namespace greatx
