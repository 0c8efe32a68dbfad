// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <condition_variable>
#include <cstdint>
#include <deque>
#include <functional>
#include <mutex>
#include <thread>
#include <vector>

namespace greatx::io {

/// Threads that take jobs in order of submission. Jobs must not throw.
class WorkerPool {
 public:
  explicit WorkerPool(uint32_t threads);  ///< 0: as many as the machine has processors
  /// Runs what was submitted, then joins.
  ~WorkerPool();
  WorkerPool(const WorkerPool&) = delete;
  WorkerPool& operator=(const WorkerPool&) = delete;

  void submit(std::function<void()> job);
  /// Runs job(0) .. job(count-1) on the workers and waits; rethrows the exception of the lowest index that
  /// had one.
  void for_each(size_t count, const std::function<void(size_t)>& job);

 private:
  void work();
  std::mutex mutex_;
  std::condition_variable wake_;
  std::deque<std::function<void()>> jobs_;
  bool closing_ = false;
  std::vector<std::thread> threads_;
};

}  // namespace greatx::io
