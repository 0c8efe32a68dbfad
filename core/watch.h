// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// How long work on the host is watched: whoever waits for it puts a WatchScope around the call, the work asks checkpoint() as
// often as it likes, on whatever thread. So nothing between the two needs to know of it.
//
//   WatchScope (the caller's thread) ─► ... ─► WorkStage("search") ─► parallel_for ─► checkpoint() on every worker
//
// The watch itself is asked on the caller's thread alone (a terminal, an interpreter), some twenty times a second: within
// that thread's own checkpoints, and while it waits for workers.
#pragma once

#include <atomic>
#include <chrono>
#include <cstdint>
#include <thread>

#include "core/error.h"

namespace greatx {

/// How far the work is.
struct WorkState {
  const char* what = nullptr;  ///< null: nothing that takes long is underway
  double share = -1.0;         ///< done, 0 to 1; an estimate, which may fall; < 0: not known
  double seconds = 0.0;        ///< since it began
};

/// Who waits.
class Watch {
 public:
  virtual ~Watch() = default;
  /// False: enough.
  virtual bool look(const WorkState& state) noexcept = 0;
  /// What look() told of is over.
  virtual void stage_ended() noexcept {}
};

namespace detail {

/// What a watch, its thread and the threads that work for it share.
class WatchedWork {
 public:
  explicit WatchedWork(Watch& watch) : watch_(watch) {}
  /// Throws Interrupted once somebody asked to stop.
  void check() {
    if (mine()) poll();
    if (stop_.load(std::memory_order_relaxed)) throw Interrupted("before it was done");
  }
  /// On the watched thread: asks the watch, if that was not just done.
  void poll();
  bool mine() const { return std::this_thread::get_id() == owner_; }

  // Of the stage.
  bool begin(const char* what);
  void end();
  void add(uint64_t done) { done_.fetch_add(done, std::memory_order_relaxed); }
  void expect(double total) { total_.store(total, std::memory_order_relaxed); }

 private:
  using Clock = std::chrono::steady_clock;
  Watch& watch_;
  const std::thread::id owner_ = std::this_thread::get_id();
  std::atomic<bool> stop_{false};
  Clock::time_point looked_ = Clock::now(), begun_;
  const char* what_ = nullptr;
  std::atomic<uint64_t> done_{0};
  std::atomic<double> total_{0.0};
};

/// Of the work that this thread does; null: nobody watches.
inline thread_local constinit WatchedWork* watched_work = nullptr;

}  // namespace detail

/// Watches what the thread does, with all threads of parallel_for, as long as this lives. `watch` outlives this.
class WatchScope {
 public:
  explicit WatchScope(Watch& watch) : work_(watch), before_(detail::watched_work) {
    detail::watched_work = &work_;
  }
  ~WatchScope() { detail::watched_work = before_; }
  WatchScope(const WatchScope&) = delete;
  WatchScope& operator=(const WatchScope&) = delete;

 private:
  detail::WatchedWork work_;
  detail::WatchedWork* before_;
};

/// Throws Interrupted if the work of this thread is watched and somebody asked to stop. Cheap enough for a loop whose turn
/// takes a microsecond.
inline void checkpoint() {
  if (detail::watched_work != nullptr) detail::watched_work->check();
}

/// Work that may take long, as long as this lives; the outermost one on the watched thread is told of.
class WorkStage {
 public:
  /// `what`: a literal.
  explicit WorkStage(const char* what)
      : work_(detail::watched_work != nullptr && detail::watched_work->mine() &&
                      detail::watched_work->begin(what)
                  ? detail::watched_work
                  : nullptr) {}
  ~WorkStage() {
    if (work_ != nullptr) work_->end();
  }
  WorkStage(const WorkStage&) = delete;
  WorkStage& operator=(const WorkStage&) = delete;

  /// So many more steps are done; from any thread.
  void add(uint64_t done) {
    if (work_ != nullptr) work_->add(done);
  }
  /// How many there will be, as far as that is known.
  void expect(double total) {
    if (work_ != nullptr) work_->expect(total);
  }

 private:
  detail::WatchedWork* work_;
};

}  // namespace greatx
