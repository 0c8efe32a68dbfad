// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Holds the threads that help parallel_for (core/parallel.h). A tick has some hundred short stages, so that
// making threads anew for each of them costs as much as the stages themselves on many cores.
//
//   parallel_for ─► SharedWork ─► WorkerPool::offer ─► helpers call help(), the caller works, too
//                             ─► WorkerPool::take_back: nobody else joins; waits for those at work
//
// The caller never depends on a helper: it does all the work itself if no helper is idle. Work within work
// (nested calls, several callers) therefore cannot block, and shares the same threads.
#pragma once

#include <condition_variable>
#include <cstddef>
#include <deque>
#include <functional>
#include <mutex>

namespace greatx::detail {

/// Represents work that helpers share with the thread that offers it.
class SharedWork {
 public:
  /// Does a share of the work, or nothing if none is left. Called on helpers' threads.
  virtual void help() noexcept = 0;

  SharedWork() = default;
  virtual ~SharedWork() = default;
  SharedWork(const SharedWork&) = delete;
  SharedWork& operator=(const SharedWork&) = delete;

 private:
  friend class WorkerPool;
  // The pool's mutex guards both.
  size_t wanted_ = 0;  ///< helpers that may still join
  size_t inside_ = 0;  ///< helpers that are at work
};

class WorkerPool {
 public:
  /// Returns the pool of this process. A child of fork() has a new one, since threads do not survive fork().
  /// The pool is never destroyed: its threads sleep until the process ends.
  static WorkerPool& instance();

  /// Lets up to `helpers` threads join the work. Starts threads if there are fewer than this. If the system
  /// gives no more threads, fewer join. A thread keeps the cores that its creator was allowed to use.
  void offer(SharedWork& work, size_t helpers);
  /// Lets nobody join any more, and waits for those who are at work. Calls `meanwhile` (null: nothing) every
  /// 20 ms as long as it waits.
  void take_back(SharedWork& work, const std::function<void()>& meanwhile);

 private:
  void grow(size_t threads);
  void run();

  std::mutex mutex_;
  std::condition_variable offered_, left_;
  std::deque<SharedWork*> offers_;  ///< work that helpers may join, the oldest first
  size_t threads_ = 0;
};

}  // namespace greatx::detail
