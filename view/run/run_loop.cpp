// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "view/run/run_loop.h"

#include <algorithm>
#include <cmath>
#include <exception>
#include <new>

#include "core/error.h"
#include "sim/scenario/rational.h"

namespace greatx::view {

namespace {

/// A tick that is later than this is the new beginning of the pace. The ticks after a slow one are therefore
/// not hurried through.
constexpr double most_behind_s = 0.1;
constexpr double longest_wait_s = 3600.0;  // one turn of waiting, so that any time fits the clock
constexpr double reached_over_s = 1.0;
/// A search that lasts longer is stopped for another command. The simulator begins anew then, which takes a
/// second or two by itself.
constexpr double longest_unwanted_s = 2.0;

double seconds_between(std::chrono::steady_clock::time_point begin,
                       std::chrono::steady_clock::time_point end) {
  return std::chrono::duration<double>(end - begin).count();
}

/// Returns the message of the exception that is being handled.
std::string message_in_flight() {
  try {
    throw;
  } catch (const std::bad_alloc&) {
    return out_of_memory();
  } catch (const std::exception& error) {
    return error.what();
  }
}

TickAt place_of(const ShownTick& tick) { return {tick.sequence, tick.packet.tick}; }

}  // namespace

RunLoop::RunLoop(Open open, bool playing) : open_(std::move(open)) {
  status_.playing = playing;
  thread_ = std::thread([this] { work(); });
}

RunLoop::~RunLoop() {
  {
    const std::lock_guard lock(mutex_);
    quit_ = true;
  }
  changed_.notify_all();
  thread_.join();
}

RunStatus RunLoop::status() const {
  const std::lock_guard lock(mutex_);
  RunStatus status = status_;
  if (const char* what = activity_ != nullptr ? activity_ : stage_) status.activity = what;
  return status;
}

std::shared_ptr<const io::DatasetInfo> RunLoop::info() const {
  const std::lock_guard lock(mutex_);
  return info_;
}

std::shared_ptr<const ShownTick> RunLoop::shown() const {
  const std::lock_guard lock(mutex_);
  return shown_;
}

void RunLoop::play(bool playing) {
  {
    const std::lock_guard lock(mutex_);
    if (status_.phase == RunStatus::Phase::failed || status_.playing == playing) return;
    status_.playing = playing;
    if (!playing) status_.reached = 0.0;
    ++pace_number_;
    ++version_;
  }
  changed_.notify_all();
}

void RunLoop::set_speed(double speed) {
  GREATX_CHECK(speed >= 0.0 && std::isfinite(speed), "speed {}", speed);
  {
    const std::lock_guard lock(mutex_);
    if (status_.speed == speed) return;
    status_.speed = speed;
    ++pace_number_;
    ++version_;
  }
  changed_.notify_all();
}

void RunLoop::step(int ticks) {
  play(false);
  if (ticks == 0) return;
  {
    const std::lock_guard lock(mutex_);
    if (status_.phase == RunStatus::Phase::failed) return;
    // Steps in one direction add up; steps back and forth do not, because a run has ends.
    if (!moves_.steps.empty() && (moves_.steps.back() > 0) == (ticks > 0))
      moves_.steps.back() += ticks;
    else
      moves_.steps.push_back(ticks);
  }
  changed_.notify_all();
}

void RunLoop::jump(uint32_t sequence, int64_t tick) {
  {
    const std::lock_guard lock(mutex_);
    if (status_.phase == RunStatus::Phase::failed) return;
    moves_ = {TickAt{sequence, tick}, {}};
  }
  changed_.notify_all();
}

bool RunLoop::look(const WorkState& state) noexcept {
  const std::lock_guard lock(mutex_);
  const double progress = state.what != nullptr ? state.share : -1.0;
  if (stage_ != state.what || status_.progress != progress) ++version_;
  stage_ = state.what;
  status_.progress = progress;
  const bool long_for_nobody = state.what != nullptr && state.seconds > longest_unwanted_s && moves_.any();
  return !quit_ && !long_for_nobody;
}

void RunLoop::stage_ended() noexcept {
  const std::lock_guard lock(mutex_);
  if (stage_ != nullptr) ++version_;
  stage_ = nullptr;
  status_.progress = -1.0;
}

void RunLoop::activity_changed(const char* what) noexcept {
  const std::lock_guard lock(mutex_);
  activity_ = what;
  ++version_;
}

void RunLoop::work() {
  const WatchScope watch(*this);
  const ActivityScope activities(*this);
  try {
    source_ = open_();
    const std::shared_ptr<const io::DatasetInfo> info = source_->info();
    const std::optional<sim::Rational> rate = sim::Rational::parse(info->tick_rate);
    if (!rate)
      throw_user_error("tick_rate_hz: expected a positive rational number, found {}", info->tick_rate);
    sequence_s_ = static_cast<double>(info->ticks_per_sequence) / rate->value();
    {
      const std::lock_guard lock(mutex_);
      info_ = info;
      status_.phase = RunStatus::Phase::ready;
      ++version_;
    }
    run();
  } catch (const Interrupted&) {  // by the destructor
  } catch (const std::exception&) {
    fail(message_in_flight());
  }
  source_.reset();  // what is on the device goes on the thread that put it there
}

void RunLoop::fail(std::string message) {
  const std::lock_guard lock(mutex_);
  status_.phase = RunStatus::Phase::failed;
  status_.error = std::move(message);
  status_.playing = false;
  status_.reached = 0.0;
  moves_ = {};
  ++version_;
}

void RunLoop::run() {
  for (;;) {
    Moves moves;
    bool playing = false;
    {
      const std::lock_guard lock(mutex_);
      if (quit_) return;
      moves = std::exchange(moves_, {});
      playing = status_.playing;
    }
    std::optional<TickAt> wanted;
    if (moves.any()) wanted = target(moves);
    const bool begins = !started_;
    started_ = true;
    if (wanted) {
      show(*wanted);
    } else if (begins) {
      if (const std::optional<TickAt> at = first(0)) show(*at);
      if (moves.any()) target(moves);  // says again what is wrong
    } else if (!moves.any()) {
      playing ? play_on() : idle();
    }
  }
}

std::optional<TickAt> RunLoop::target(const Moves& moves) {
  std::optional<TickAt> at = cursor_;
  if (moves.jump) {
    at = checked(*moves.jump);
    if (!at) return {};
  }
  if (!at) at = first(0);  // as if it had been shown, so that steps do not depend on how long opening takes
  for (int64_t left : moves.steps)
    for (; left != 0; left += left > 0 ? -1 : 1) {
      checkpoint();
      const std::optional<TickAt> next = !at ? at : left > 0 ? after(*at) : before(*at);
      if (!next) break;
      at = next;
    }
  return at;
}

std::optional<TickAt> RunLoop::checked(TickAt jump) {
  const io::DatasetInfo& info = *source_->info();
  std::string error;
  if (jump.sequence >= info.sequences)
    error =
        fmt::format("expected a sequence from 0 to {}, found {}", int64_t{info.sequences} - 1, jump.sequence);
  else if (jump.tick < 0 || jump.tick >= info.ticks_per_sequence)
    error = fmt::format("expected a tick from 0 to {}, found {}", info.ticks_per_sequence - 1, jump.tick);
  int64_t tick = -1;
  if (error.empty()) {
    tick = source_->next(jump.sequence, jump.tick);
    if (tick < 0) tick = source_->previous(jump.sequence, jump.tick);  // it lies behind the last one
    if (tick >= 0) return TickAt{jump.sequence, tick};
    error = fmt::format("sequence {} has no tick at which a sensor delivers", jump.sequence);
  }
  const std::lock_guard lock(mutex_);
  status_.error = std::move(error);
  ++version_;
  return {};
}

std::optional<TickAt> RunLoop::first(uint32_t sequence) const {
  for (; sequence < source_->info()->sequences; ++sequence)
    if (const int64_t tick = source_->next(sequence, 0); tick >= 0) return TickAt{sequence, tick};
  return {};
}

std::optional<TickAt> RunLoop::after(TickAt at) const {
  if (const int64_t tick = source_->next(at.sequence, at.tick + 1); tick >= 0)
    return TickAt{at.sequence, tick};
  return first(at.sequence + 1);
}

std::optional<TickAt> RunLoop::before(TickAt at) const {
  if (const int64_t tick = source_->previous(at.sequence, at.tick); tick >= 0)
    return TickAt{at.sequence, tick};
  while (at.sequence > 0) {
    --at.sequence;
    const int64_t tick = source_->previous(at.sequence, source_->info()->ticks_per_sequence);
    if (tick >= 0) return TickAt{at.sequence, tick};
  }
  return {};
}

TickSource::Loaded RunLoop::load(TickAt at, bool goes_on) {
  const WatchScope watch(*this);  // of this tick alone: the work may be stopped for another command
  try {
    return source_->load(at, goes_on, [this] {
      const std::lock_guard lock(mutex_);
      return interrupted();
    });
  } catch (const Interrupted&) {
    const std::lock_guard lock(mutex_);
    if (quit_) throw;
    return {};
  } catch (const std::exception&) {
    cursor_ = at;
    const std::lock_guard lock(mutex_);
    status_.error = fmt::format("{} (sequence {}, tick {})", message_in_flight(), at.sequence, at.tick);
    status_.playing = false;
    status_.reached = 0.0;
    ++version_;
    return {};
  }
}

/// Shows a tick that a command asks for, without pipelining, because nobody knows what is wanted next.
void RunLoop::show(TickAt at) {
  backwards_ = cursor_ && at < *cursor_;
  TickSource::Loaded loaded = load(at, false);
  cursor_ = at;
  if (!loaded.tick) return;
  publish(std::move(loaded), false);
}

void RunLoop::play_on() {
  const std::optional<TickAt> next = cursor_ ? after(*cursor_) : first(0);
  if (!next) {
    const std::lock_guard lock(mutex_);
    if (moves_.any()) return;
    status_.playing = false;
    status_.reached = 0.0;
    ++version_;
    return;
  }
  backwards_ = false;
  begin_pace();
  TickSource::Loaded loaded = load(*next, true);
  if (!loaded.tick || !wait_for(*loaded.tick)) return;
  publish(std::move(loaded), true);
}

/// Begins the pace at the tick shown, if something has changed it.
void RunLoop::begin_pace() {
  const std::lock_guard lock(mutex_);
  if (pace_.number == pace_number_) return;
  pace_ = {pace_number_, Clock::now(), {}};
  recent_.clear();
  if (!shown_ || place_of(*shown_) != cursor_) return;
  pace_.since_s = seconds_of(*shown_);
  recent_.emplace_back(pace_.since, *pace_.since_s);
}

bool RunLoop::wait_for(const ShownTick& tick) {
  const double simulated_s = seconds_of(tick);
  for (;;) {
    begin_pace();
    double left_s = 0.0;
    {
      const std::lock_guard lock(mutex_);
      if (interrupted() || !status_.playing) return false;
      if (pace_.number != pace_number_) continue;
      const Clock::time_point now = Clock::now();
      if (!pace_.since_s) pace_.since_s = simulated_s;
      if (status_.speed > 0.0)
        left_s = (simulated_s - *pace_.since_s) / status_.speed - seconds_between(pace_.since, now);
      if (left_s < -most_behind_s) {
        pace_.since = now;
        pace_.since_s = simulated_s;
      }
      if (left_s <= 0.0) return true;
    }
    if (source_->look_ahead(place_of(tick), false)) continue;
    std::unique_lock lock(mutex_);
    changed_.wait_for(lock, std::chrono::duration<double>(std::min(left_s, longest_wait_s)),
                      [this] { return interrupted() || !status_.playing || pace_.number != pace_number_; });
  }
}

void RunLoop::idle() {
  if (cursor_ && source_->look_ahead(*cursor_, backwards_)) return;
  std::unique_lock lock(mutex_);
  changed_.wait(lock, [this] { return interrupted() || status_.playing; });
}

void RunLoop::publish(TickSource::Loaded loaded, bool by_playing) {
  const TickAt at = place_of(*loaded.tick);
  const double simulated_s = seconds_of(*loaded.tick);
  std::shared_ptr<const ShownTick> before = std::move(loaded.tick);  // freed without the lock
  const std::lock_guard lock(mutex_);
  if (by_playing && (interrupted() || !status_.playing)) return;  // nothing moves on once play(false) is back
  cursor_ = at;
  shown_.swap(before);
  status_.sequence = at.sequence;
  status_.tick = at.tick;
  status_.error = std::move(loaded.error);
  if (loaded.stops) status_.playing = false;
  if (!by_playing) ++pace_number_;
  if (!by_playing || !status_.playing) {
    status_.reached = 0.0;
  } else {
    const Clock::time_point now = Clock::now();
    recent_.emplace_back(now, simulated_s);
    while (recent_.size() > 2 && seconds_between(recent_[1].first, now) >= reached_over_s)
      recent_.pop_front();
    const double wall_s = seconds_between(recent_.front().first, now);
    if (wall_s > 0.0) status_.reached = (simulated_s - recent_.front().second) / wall_s;
  }
  ++version_;
}

/// Returns the simulated time of a tick, where each sequence follows the one before.
double RunLoop::seconds_of(const ShownTick& tick) const {
  return tick.sequence * sequence_s_ + 1e-9 * static_cast<double>(tick.packet.time_ns);
}

}  // namespace greatx::view
