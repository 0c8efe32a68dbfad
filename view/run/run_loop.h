// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// The thread of a run: takes commands, keeps the pace and publishes ticks, whatever their source.
#pragma once

#include <atomic>
#include <chrono>
#include <condition_variable>
#include <cstdint>
#include <deque>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "core/activity.h"
#include "core/watch.h"
#include "view/run/run.h"
#include "view/run/tick_source.h"

namespace greatx::view {

/// Every public function may be called from any thread, and returns at once. Of `status_`, callers change
/// what they ask for (playing, speed), and the run's thread changes the rest.
class RunLoop : private Watch, private ActivityListener {
 public:
  /// Opens the source on the run's thread. What it throws becomes status().error.
  using Open = std::function<std::unique_ptr<TickSource>()>;
  RunLoop(Open open, bool playing);
  /// Asks the thread to stop and waits for it.
  ~RunLoop() override;
  RunLoop(const RunLoop&) = delete;
  RunLoop& operator=(const RunLoop&) = delete;

  RunStatus status() const;
  std::shared_ptr<const io::DatasetInfo> info() const;
  std::shared_ptr<const ShownTick> shown() const;
  uint64_t version() const { return version_.load(); }
  void play(bool playing);
  void set_speed(double speed);
  void step(int ticks);
  void jump(uint32_t sequence, int64_t tick);

 private:
  using Clock = std::chrono::steady_clock;
  /// Holds the ticks that commands ask for: first the jump, then each step from the tick before it.
  struct Moves {
    std::optional<TickAt> jump;
    std::vector<int64_t> steps;
    bool any() const { return jump || !steps.empty(); }
  };
  /// Holds what the thread needs of the pace.
  struct Pace {
    uint64_t number = ~uint64_t{0};  ///< of the pace_ that it follows
    Clock::time_point since;
    std::optional<double> since_s;  ///< simulated time at `since`; none: that of the next tick
  };

  bool look(const WorkState& state) noexcept override;
  void stage_ended() noexcept override;
  void activity_changed(const char* what) noexcept override;

  void work();
  void run();
  void fail(std::string message);
  /// Returns the tick that the moves lead to; nothing if they lead nowhere, which may be an error.
  std::optional<TickAt> target(const Moves& moves);
  std::optional<TickAt> checked(TickAt jump);
  std::optional<TickAt> first(uint32_t sequence) const;
  std::optional<TickAt> after(TickAt at) const;
  std::optional<TickAt> before(TickAt at) const;
  void show(TickAt at);
  void play_on();
  void begin_pace();
  /// Waits until the tick is due. Returns false if another command comes first.
  bool wait_for(const ShownTick& tick);
  void idle();
  /// Loads the tick. A failure counts as the tick shown.
  TickSource::Loaded load(TickAt at, bool goes_on);
  void publish(TickSource::Loaded loaded, bool by_playing);
  double seconds_of(const ShownTick& tick) const;
  bool interrupted() const { return quit_ || moves_.any(); }  ///< under mutex_

  Open open_;
  // The members below belong to the thread.
  std::unique_ptr<TickSource> source_;
  double sequence_s_ = 0.0;       ///< simulated time of a sequence
  std::optional<TickAt> cursor_;  ///< shown, failed or given up last: where steps begin
  bool started_ = false, backwards_ = false;
  Pace pace_;
  std::deque<std::pair<Clock::time_point, double>> recent_;  ///< played ticks: when, and their simulated time

  mutable std::mutex mutex_;
  std::condition_variable changed_;
  // The members below are shared.
  RunStatus status_;
  const char* activity_ = nullptr;  ///< a literal
  const char* stage_ = nullptr;     ///< a literal
  Moves moves_;
  uint64_t pace_number_ = 0;  ///< changes when the pace begins anew
  bool quit_ = false;
  std::shared_ptr<const io::DatasetInfo> info_;
  std::shared_ptr<const ShownTick> shown_;
  std::atomic<uint64_t> version_{0};
  std::thread thread_;
};

/// A run of that interface whose thread is a RunLoop.
template <typename Interface>
class Looped : public Interface {
 public:
  Looped(RunLoop::Open open, bool playing) : loop_(std::move(open), playing) {}
  RunStatus status() const override { return loop_.status(); }
  std::shared_ptr<const io::DatasetInfo> info() const override { return loop_.info(); }
  std::shared_ptr<const ShownTick> shown() const override { return loop_.shown(); }
  uint64_t version() const override { return loop_.version(); }
  void play(bool playing) override { loop_.play(playing); }
  void set_speed(double speed) override { loop_.set_speed(speed); }
  void step(int ticks) override { loop_.step(ticks); }
  void jump(uint32_t sequence, int64_t tick) override { loop_.jump(sequence, tick); }

 private:
  RunLoop loop_;
};

}  // namespace greatx::view
