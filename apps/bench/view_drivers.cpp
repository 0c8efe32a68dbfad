// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "apps/bench/view_drivers.h"

#include <algorithm>
#include <cmath>

#include "core/error.h"
#include "view/panel/panel.h"

namespace greatx::apps {

namespace {

using Kind = view::InputEvent::Kind;

constexpr double reach_px = 150.0, speed_px_per_s = 300.0;  ///< of the mouse while it orbits
constexpr double drag_px = 40.0;
/// Frames before a measurement, so that ImGui has opened what a command has opened.
constexpr int settling_frames = 20;

void check_run(const view::ScriptHost& host) {
  const view::RunStatus status = host.run().status();
  if (!status.error.empty()) throw UserError(status.error);
}

bool same(const Pose& a, const Pose& b) { return a.position == b.position && a.orientation == b.orientation; }
const Pose& pose_of(const view::SceneRequest& request) { return request.view.local_from_sensor; }

}  // namespace

OrbitDriver::OrbitDriver(int width, int height, double seconds, uint32_t drags)
    : x_(0.28 * width), y_(0.5 * height), seconds_(seconds), drags_(drags) {}

void OrbitDriver::mouse(const view::ScriptHost& host, Kind kind, double x) const {
  view::InputEvent event;
  event.kind = kind;
  event.x = x;
  event.y = y_;
  host.inject(event);
}

/// Moves the mouse to and fro at a constant speed.
void OrbitDriver::orbit(const view::ScriptHost& host) {
  const double way = std::fmod(speed_px_per_s * seconds_since(begin_), 4.0 * reach_px);
  mouse(host, Kind::move, x_ + reach_px - std::abs(way - 2.0 * reach_px));
  motions_.push_back({Clock::now(), false, {}});
}

bool OrbitDriver::is_new(const view::FrameContent& content) {
  return std::exchange(last_, content.picture) != content.picture;
}

void OrbitDriver::count(const view::FrameContent& content) {
  ++frames_;
  if (!is_new(content)) return;
  ++pictures_;
  picture_ms_.push_back(content.picture->milliseconds);
}

void OrbitDriver::track(const view::ScriptHost& host, const view::FrameContent& content,
                        std::vector<double>& ms) {
  // The frame took the motion that was injected before it, and asked for its picture.
  for (Motion& motion : motions_)
    if (!std::exchange(motion.asked, true)) motion.pose = pose_of(content.wanted);
  if (!is_new(content)) return;
  const auto shown = std::find_if(motions_.rbegin(), motions_.rend(), [&](const Motion& motion) {
    return same(motion.pose, pose_of(content.picture->request));
  });
  if (shown == motions_.rend()) return;
  host.finish();
  const Clock::time_point now = Clock::now();
  // The picture shows all motions up to this one.
  for (auto motion = motions_.begin(); motion != shown.base(); ++motion)
    ms.push_back(std::chrono::duration<double, std::milli>(now - motion->injected).count());
  motions_.erase(motions_.begin(), shown.base());
}

/// Moves once from rest and waits for the picture. Returns whether it has been shown.
bool OrbitDriver::drag(const view::ScriptHost& host, const view::FrameContent& content) {
  const size_t before = resting_ms_.size();
  track(host, content, resting_ms_);
  if (resting_ms_.size() == before) return false;
  mouse(host, Kind::release, x_ + drag_px);
  return true;
}

bool OrbitDriver::after_frame(const view::ScriptHost& host) {
  check_run(host);
  const view::FrameContent content = host.content();
  switch (phase_) {
    case Phase::opening:
      if (!host.ready() || !host.settled()) break;
      for (const char* overlay : {"paths", "lidar", "radar", "boxes", "trajectories", "sensors"})
        host.act(std::string("show.") + overlay, "on");
      mouse(host, Kind::move, x_);
      phase_ = Phase::settling;
      break;
    case Phase::settling:
      if (++waited_ < settling_frames || !host.settled()) break;
      mouse(host, Kind::press, x_);
      phase_ = Phase::pressing;
      begin_ = Clock::now();
      break;
    case Phase::pressing:
      orbit(host);
      if (seconds_since(begin_) < 0.5) break;
      phase_ = Phase::orbiting;
      begin_ = Clock::now();
      is_new(content);
      break;
    case Phase::orbiting:
      count(content);
      orbit(host);
      orbited_s_ = seconds_since(begin_);
      if (orbited_s_ < seconds_) break;
      phase_ = Phase::tracking;
      motions_.erase(motions_.begin(), motions_.end() - 1);
      break;
    case Phase::tracking:
      track(host, content, moving_ms_);
      if (seconds_since(begin_) < 2.0 * seconds_) {
        orbit(host);
        break;
      }
      mouse(host, Kind::release, x_);
      phase_ = Phase::at_rest;
      waited_ = 0;
      break;
    case Phase::at_rest:
      if (!host.settled() || ++waited_ < settling_frames) break;
      if (resting_ms_.size() >= drags_) return false;
      // A press is a frame of its own; the motion comes after it.
      if (waited_ == settling_frames) mouse(host, Kind::press, x_);
      if (waited_ < settling_frames + 3) break;
      motions_.assign(1, {Clock::now(), false, {}});
      last_ = content.picture;
      mouse(host, Kind::move, x_ + drag_px);
      phase_ = Phase::dragging;
      break;
    case Phase::dragging:
      if (!drag(host, content)) break;
      phase_ = Phase::at_rest;
      waited_ = 0;
      break;
  }
  return true;
}

bool FollowDriver::after_frame(const view::ScriptHost& host) {
  check_run(host);
  const view::FrameContent content = host.content();
  if (content.tick == nullptr || content.picture == nullptr) return true;
  if (!plays_) {
    plays_ = true;
    host.act("every-tick", every_tick_ ? "on" : "off");
    host.run().set_speed(0.0);
    host.run().play(true);
  }
  ++frames_;
  const int64_t tick = content.tick->packet.tick;
  if (times_.empty() || times_.back().tick != tick)
    times_.push_back({tick, Clock::now(), cpu_milliseconds()});
  if (content.picture != nullptr && content.picture->request.tick != pictured_) {
    pictured_ = content.picture->request.tick;
    ++pictures_;
  }
  return tick < last_;
}

void ScrubDriver::open_panels(const view::ScriptHost& host) {
  host.act("panels.close", "");
  const std::vector<view::PanelChoice> choices = view::panels_of(host.run().info()->sensors);
  const auto open = [&](const view::PanelChoice& choice) {
    host.act("panel", choice.title);
    ++panels_;
  };
  std::vector<bool> opened(choices.size(), false);
  for (const char* kind : {"rgb", "from above", "range-Doppler", "delay over time"}) {
    const auto found = std::ranges::find(choices, kind, &view::PanelChoice::kind);
    if (found == choices.end()) continue;
    open(*found);
    opened[static_cast<size_t>(found - choices.begin())] = true;
  }
  for (size_t i = 0; i < choices.size() && panels_ < 4; ++i)
    if (!opened[i]) open(choices[i]);
}

bool ScrubDriver::after_frame(const view::ScriptHost& host) {
  check_run(host);
  if (!opened_) {
    if (!host.ready() || !host.settled()) return true;
    open_panels(host);
    opened_ = true;
  }
  const std::shared_ptr<const view::ShownTick> tick = host.content().tick;
  if (++waited_ < settling_frames) return true;
  if (waited_ == settling_frames) {
    before_ = tick;
    begin_ = Clock::now();
    host.run().step(1);
  }
  if (tick == before_) return true;
  before_ = tick;
  Pass& pass = backwards_ ? again_ : first_;
  ++pass.ticks;
  pass.seconds = seconds_since(begin_);
  if (pass.ticks + 1 == ticks_) {
    if (backwards_) return false;
    backwards_ = true;
    begin_ = Clock::now();
  }
  host.run().step(backwards_ ? -1 : 1);
  return true;
}

}  // namespace greatx::apps
