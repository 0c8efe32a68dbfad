// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <atomic>
#include <chrono>
#include <condition_variable>
#include <cstddef>
#include <cstdint>
#include <exception>
#include <mutex>
#include <sched.h>
#include <thread>
#include <vector>

#include "core/watch.h"

namespace greatx {

/// Counts the cores that this process may run on. Under taskset or in a container there are fewer than the
/// machine has.
inline size_t usable_cores() {
  cpu_set_t cores;
  if (sched_getaffinity(0, sizeof cores, &cores) == 0 && CPU_COUNT(&cores) > 0)
    return static_cast<size_t>(CPU_COUNT(&cores));
  return std::max(1u, std::thread::hardware_concurrency());
}

/// Returns the threads that each of `count` works may use that run side by side.
inline uint32_t threads_of_each(size_t count) {
  return static_cast<uint32_t>(std::max<size_t>(1, usable_cores() / std::max<size_t>(1, count)));
}

/// Calls work(index) for every index below `count`, on up to `threads` threads (0: usable_cores()). Chance
/// decides which thread takes which index, so work() must write only to data that belongs to its index: the
/// result then does not depend on chance. The first exception is thrown again here. If the caller's work is
/// watched (core/watch.h), the watch covers all these threads and is asked before each index.
template <typename Work>
void parallel_for(size_t count, uint32_t threads, const Work& work) {
  const size_t workers = std::min(count, threads == 0 ? usable_cores() : size_t{threads});
  if (workers <= 1) {
    for (size_t index = 0; index < count; ++index) {
      checkpoint();
      work(index);
    }
    return;
  }
  std::atomic<size_t> next{0};
  std::exception_ptr failure;
  size_t running = workers - 1;
  std::mutex mutex;
  std::condition_variable one_ended;
  detail::WatchedWork* const watched = detail::watched_work;
  const auto run = [&] {
    try {
      for (size_t index = next++; index < count; index = next++) {
        checkpoint();
        work(index);
      }
    } catch (...) {
      const std::lock_guard lock(mutex);
      if (!failure) failure = std::current_exception();
      next = count;
    }
  };
  const auto run_beside = [&] {
    detail::watched_work = watched;
    run();
    const std::lock_guard lock(mutex);
    --running;
    one_ended.notify_one();
  };
  std::vector<std::thread> pool;
  for (size_t i = 1; i < workers; ++i) pool.emplace_back(run_beside);
  run();
  if (watched != nullptr && watched->mine()) {
    // The waiting caller hears of the progress, and may stop the other threads, while the last of them are at
    // work.
    std::unique_lock lock(mutex);
    while (!one_ended.wait_for(lock, std::chrono::milliseconds(20), [&] { return running == 0; })) {
      lock.unlock();
      watched->poll();
      lock.lock();
    }
  }
  for (std::thread& thread : pool) thread.join();
  if (failure) std::rethrow_exception(failure);
}

}  // namespace greatx
