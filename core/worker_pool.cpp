// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "core/worker_pool.h"

#include <algorithm>
#include <atomic>
#include <chrono>
#include <pthread.h>
#include <system_error>
#include <thread>

namespace greatx::detail {
namespace {

std::atomic<WorkerPool*> the_pool{nullptr};

}  // namespace

WorkerPool& WorkerPool::instance() {
  WorkerPool* pool = the_pool.load(std::memory_order_acquire);
  if (pool != nullptr) return *pool;
  static const int at_fork = pthread_atfork(nullptr, nullptr, [] { the_pool = nullptr; });
  static_cast<void>(at_fork);
  auto* const made = new WorkerPool;
  if (the_pool.compare_exchange_strong(pool, made)) return *made;
  delete made;  // another thread was quicker
  return *pool;
}

void WorkerPool::offer(SharedWork& work, size_t helpers) {
  {
    const std::lock_guard lock(mutex_);
    if (threads_ < helpers) grow(helpers);
    work.wanted_ = helpers;
    offers_.push_back(&work);
  }
  if (helpers == 1)
    offered_.notify_one();
  else
    offered_.notify_all();
}

void WorkerPool::take_back(SharedWork& work, const std::function<void()>& meanwhile) {
  std::unique_lock lock(mutex_);
  if (work.wanted_ > 0) offers_.erase(std::find(offers_.begin(), offers_.end(), &work));
  const auto done = [&] { return work.inside_ == 0; };
  if (!meanwhile) return left_.wait(lock, done);
  while (!left_.wait_for(lock, std::chrono::milliseconds(20), done)) {
    lock.unlock();
    meanwhile();
    lock.lock();
  }
}

void WorkerPool::grow(size_t threads) {
  try {
    for (; threads_ < threads; ++threads_) std::thread([this] { run(); }).detach();
  } catch (const std::system_error&) {
    // The system has no more threads. Those that there are do the work.
  }
}

void WorkerPool::run() {
  std::unique_lock lock(mutex_);
  for (;;) {
    offered_.wait(lock, [&] { return !offers_.empty(); });
    SharedWork& work = *offers_.front();
    ++work.inside_;
    if (--work.wanted_ == 0) offers_.pop_front();
    lock.unlock();
    work.help();
    lock.lock();
    if (--work.inside_ == 0) left_.notify_all();
  }
}

}  // namespace greatx::detail
