// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <exception>
#include <mutex>
#include <sched.h>
#include <thread>
#include <vector>

namespace greatx {

/// Cores that this process may run on: fewer than the machine has under taskset or in a container.
inline size_t usable_cores() {
  cpu_set_t cores;
  if (sched_getaffinity(0, sizeof cores, &cores) == 0 && CPU_COUNT(&cores) > 0)
    return static_cast<size_t>(CPU_COUNT(&cores));
  return std::max(1u, std::thread::hardware_concurrency());
}

/// Calls work(index) for every index below `count`, on up to `threads` threads (0: usable_cores()). Which
/// thread takes which index is chance: work() must write to what belongs to its index alone, so that the result is
/// not. The first exception is thrown again here.
template <typename Work>
void parallel_for(size_t count, uint32_t threads, const Work& work) {
  const size_t workers = std::min(count, threads == 0 ? usable_cores() : size_t{threads});
  if (workers <= 1) {
    for (size_t index = 0; index < count; ++index) work(index);
    return;
  }
  std::atomic<size_t> next{0};
  std::exception_ptr failure;
  std::mutex mutex;
  const auto run = [&] {
    try {
      for (size_t index = next++; index < count; index = next++) work(index);
    } catch (...) {
      const std::lock_guard lock(mutex);
      if (!failure) failure = std::current_exception();
      next = count;
    }
  };
  std::vector<std::thread> pool;
  for (size_t i = 1; i < workers; ++i) pool.emplace_back(run);
  run();
  for (std::thread& thread : pool) thread.join();
  if (failure) std::rethrow_exception(failure);
}

}  // namespace greatx
