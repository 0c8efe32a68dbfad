// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Watches long work on the host. The caller that waits for the work puts a WatchScope around the call. The
// work calls checkpoint() as often as it likes, on any thread. Code between the two needs to know nothing of
// it.
//
//   WatchScope (the caller's thread) ─► ... ─► WorkStage("search") ─► parallel_for
//     ─► checkpoint() on every worker
//
// The watch itself is asked only on the caller's thread, since it may be a terminal or an interpreter. It is
// asked some twenty times a second: within that thread's own checkpoints, and while that thread waits for
// workers.
#pragma once

#include <atomic>
#include <chrono>
#include <cstdint>
#include <thread>

#include "core/error.h"

namespace greatx {

/// Describes the progress of the work.
struct WorkState {
  const char* what = nullptr;  ///< null: no long work is underway
  double share = -1.0;         ///< share done, 0 to 1; an estimate, which may fall; < 0: unknown
  double seconds = 0.0;        ///< since it began
};

/// Represents the party that waits for the work.
class Watch {
 public:
  virtual ~Watch() = default;
  /// Returns false to stop the work.
  virtual bool look(const WorkState& state) noexcept = 0;
  /// Called when the stage that look() reported is over.
  virtual void stage_ended() noexcept {}
};

namespace detail {

/// Represents the state that a watch, its thread and the threads that work for it share.
class WatchedWork {
 public:
  explicit WatchedWork(Watch& watch) : watch_(watch) {}
  /// Throws Interrupted once the watch has asked to stop.
  void check() {
    if (mine()) poll();
    if (stop_.load(std::memory_order_relaxed)) throw Interrupted("before it was done");
  }
  /// On the watched thread, asks the watch unless it was asked just before.
  void poll();
  bool mine() const { return std::this_thread::get_id() == owner_; }

  // The members below belong to the stage.
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

/// The watched work that this thread takes part in. Null: nobody watches.
inline thread_local constinit WatchedWork* watched_work = nullptr;

}  // namespace detail

/// As long as this lives, it watches the work of its thread and of all threads of parallel_for. `watch`
/// outlives it.
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

/// Throws Interrupted if the work of this thread is watched and the watch has asked to stop. The call is
/// cheap enough for a loop whose turn takes a microsecond.
inline void checkpoint() {
  if (detail::watched_work != nullptr) detail::watched_work->check();
}

/// Marks work that may take long, as long as this lives. The watch hears of the outermost stage on the
/// watched thread.
class WorkStage {
 public:
  /// `what` is a literal.
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

  /// Reports that `done` more steps are done. Any thread may call it.
  void add(uint64_t done) {
    if (work_ != nullptr) work_->add(done);
  }
  /// States how many steps there will be, as far as that is known.
  void expect(double total) {
    if (work_ != nullptr) work_->expect(total);
  }

 private:
  detail::WatchedWork* work_;
};

}  // namespace greatx
