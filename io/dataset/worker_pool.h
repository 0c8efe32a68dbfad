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

/// Runs jobs on threads, which take the jobs in order of submission. Jobs must not throw.
class WorkerPool {
 public:
  explicit WorkerPool(uint32_t threads);  ///< 0 stands for the number of processors
  /// Runs all submitted jobs, then joins the threads.
  ~WorkerPool();
  WorkerPool(const WorkerPool&) = delete;
  WorkerPool& operator=(const WorkerPool&) = delete;

  void submit(std::function<void()> job);
  /// Runs job(0) .. job(count-1) on the workers and waits for them. These jobs may throw: the exception of
  /// the lowest index is rethrown. Must not be called from a worker.
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
