// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <exception>
#include <functional>
#include <mutex>
#include <sched.h>
#include <thread>
#include <utility>
#include <vector>

#include "core/watch.h"
#include "core/worker_pool.h"

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

namespace detail {

/// Shares the indices of a loop among the threads that take part in it.
template <typename Work>
class SharedLoop final : public SharedWork {
 public:
  SharedLoop(size_t count, const Work& work) : count_(count), work_(work) {}
  /// Does all indices on this thread and up to `helpers` others. Throws the first exception of the work.
  void run(size_t helpers) {
    WorkerPool& pool = WorkerPool::instance();
    pool.offer(*this, helpers);
    take_part();
    std::function<void()> poll;
    // The waiting caller hears of the progress, and may stop the other threads, while the last of them are at
    // work.
    if (watched_ != nullptr && watched_->mine()) poll = [this] { watched_->poll(); };
    pool.take_back(*this, poll);
    if (failure_) std::rethrow_exception(failure_);
  }
  void help() noexcept override {
    watched_work = watched_;
    take_part();
    watched_work = nullptr;
  }

 private:
  void take_part() noexcept {
    try {
      for (size_t index = next_++; index < count_; index = next_++) {
        checkpoint();
        work_(index);
      }
    } catch (...) {
      const std::lock_guard lock(mutex_);
      if (!failure_) failure_ = std::current_exception();
      next_ = count_;
    }
  }

  const size_t count_;
  const Work& work_;
  WatchedWork* const watched_ = watched_work;
  std::atomic<size_t> next_{0};
  std::mutex mutex_;
  std::exception_ptr failure_;
};

}  // namespace detail

/// Calls work(index) for every index below `count`, on up to `threads` threads (0: usable_cores()): that of
/// the caller and those of the process's pool (core/worker_pool.h). Chance decides which thread takes which
/// index, so work() must write only to data that belongs to its index: the result then does not depend on
/// chance. No work may wait for another one. The first exception is thrown again here. If the caller's work
/// is watched (core/watch.h), the watch covers all these threads and is asked before each index.
template <typename Work>
void parallel_for(size_t count, uint32_t threads, const Work& work) {
  const size_t workers = std::min(count, threads == 0 ? usable_cores() : size_t{threads});
  if (workers > 1) return detail::SharedLoop<Work>(count, work).run(workers - 1);
  for (size_t index = 0; index < count; ++index) {
    checkpoint();
    work(index);
  }
}

/// Holds loops that do not depend on each other, to be done side by side: a thread that finds nothing left to
/// do in one loop goes on in the next. The longest loops come first.
class LoopsBeside {
 public:
  void add(size_t count, std::function<void(size_t index)> work) {
    loops_.push_back({count_, std::move(work)});
    count_ += count;
  }
  /// Does all indices of all loops as parallel_for does.
  void run(uint32_t threads) const {
    parallel_for(count_, threads, [&](size_t index) {
      size_t at = loops_.size() - 1;
      while (loops_[at].first > index) --at;
      loops_[at].work(index - loops_[at].first);
    });
  }

 private:
  struct Loop {
    size_t first = 0;  ///< among the indices of all loops
    std::function<void(size_t)> work;
  };
  std::vector<Loop> loops_;
  size_t count_ = 0;
};

}  // namespace greatx
