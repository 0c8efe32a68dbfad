// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "io/dataset/worker_pool.h"

#include <algorithm>
#include <exception>
#include <latch>

namespace greatx::io {

WorkerPool::WorkerPool(uint32_t threads) {
  const uint32_t count = threads > 0 ? threads : std::max(1u, std::thread::hardware_concurrency());
  for (uint32_t i = 0; i < count; ++i) threads_.emplace_back([this] { work(); });
}

WorkerPool::~WorkerPool() {
  {
    const std::lock_guard lock(mutex_);
    closing_ = true;
  }
  wake_.notify_all();
  for (std::thread& thread : threads_) thread.join();
}

void WorkerPool::submit(std::function<void()> job) {
  {
    const std::lock_guard lock(mutex_);
    jobs_.push_back(std::move(job));
  }
  wake_.notify_one();
}

void WorkerPool::for_each(size_t count, const std::function<void(size_t)>& job) {
  std::vector<std::exception_ptr> errors(count);
  std::latch done(static_cast<std::ptrdiff_t>(count));
  for (size_t i = 0; i < count; ++i) {
    submit([&, i] {
      try {
        job(i);
      } catch (...) {
        errors[i] = std::current_exception();
      }
      done.count_down();
    });
  }
  done.wait();
  for (const std::exception_ptr& error : errors)
    if (error) std::rethrow_exception(error);
}

void WorkerPool::work() {
  for (;;) {
    std::unique_lock lock(mutex_);
    wake_.wait(lock, [this] { return closing_ || !jobs_.empty(); });
    if (jobs_.empty()) return;
    const std::function<void()> job = std::move(jobs_.front());
    jobs_.pop_front();
    lock.unlock();
    job();
  }
}

}  // namespace greatx::io
