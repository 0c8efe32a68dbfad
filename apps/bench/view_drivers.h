// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Programs that drive the viewer and measure what it shows. Each is called after every frame.
#pragma once

#include <cstdint>
#include <deque>
#include <memory>
#include <vector>

#include "apps/bench/measure.h"
#include "view/app/script_runner.h"

namespace greatx::apps {

class ViewDriver {
 public:
  virtual ~ViewDriver() = default;
  /// Returns false when it has measured all. Throws UserError if the run has failed.
  virtual bool after_frame(const view::ScriptHost& host) = 0;
};

/// Orbits with all overlays, then drags from rest.
class OrbitDriver : public ViewDriver {
 public:
  OrbitDriver(int width, int height, double seconds, uint32_t drags);
  bool after_frame(const view::ScriptHost& host) override;

  double pictures_per_s() const { return static_cast<double>(pictures_) / orbited_s_; }
  double frames_per_s() const { return static_cast<double>(frames_) / orbited_s_; }
  const std::vector<double>& picture_ms() const { return picture_ms_; }  ///< of each picture of the orbit
  const std::vector<double>& moving_ms() const { return moving_ms_; }    ///< from a motion to its picture
  const std::vector<double>& resting_ms() const { return resting_ms_; }  ///< from the first motion of a drag

 private:
  enum class Phase : uint8_t { opening, settling, pressing, orbiting, tracking, at_rest, dragging };
  /// A motion of the mouse whose picture has not been seen.
  struct Motion {
    Clock::time_point injected;
    bool asked = false;  ///< the viewer has asked for `pose`
    Pose pose;
  };
  void mouse(const view::ScriptHost& host, view::InputEvent::Kind kind, double x) const;
  void orbit(const view::ScriptHost& host);
  bool is_new(const view::FrameContent& content);
  void count(const view::FrameContent& content);
  /// Takes the motions whose picture has been shown, and adds their times to `ms`.
  void track(const view::ScriptHost& host, const view::FrameContent& content, std::vector<double>& ms);
  bool drag(const view::ScriptHost& host, const view::FrameContent& content);

  const double x_, y_, seconds_;
  const uint32_t drags_;
  Phase phase_ = Phase::opening;
  int waited_ = 0;
  Clock::time_point begin_;
  double orbited_s_ = 0.0;
  uint64_t frames_ = 0, pictures_ = 0;
  std::shared_ptr<const view::ScenePicture> last_;
  std::deque<Motion> motions_;
  std::vector<double> picture_ms_, moving_ms_, resting_ms_;
};

/// When the tick was there.
struct TickTime {
  int64_t tick = 0;
  Clock::time_point at;
  double cpu_ms = 0.0;  ///< that all threads of this process have taken until then
};

/// Lets a live run play as fast as it can, as soon as the scene's picture is there. The run must wait at its
/// first tick.
class FollowDriver : public ViewDriver {
 public:
  /// Ends after `last`. `every_tick`: each tick is shown, however much that slows the run down.
  FollowDriver(int64_t last, bool every_tick) : last_(last), every_tick_(every_tick) {}
  bool after_frame(const view::ScriptHost& host) override;
  const std::vector<TickTime>& times() const { return times_; }  ///< of the ticks that frames have shown
  size_t pictures() const { return pictures_; }                  ///< of the scene, of different ticks
  size_t frames() const { return frames_; }

 private:
  const int64_t last_;
  const bool every_tick_;
  bool plays_ = false;
  std::vector<TickTime> times_;
  int64_t pictured_ = -1;
  size_t pictures_ = 0, frames_ = 0;
};

/// Visits each tick of a data set in turn, first onwards, then backwards.
class ScrubDriver : public ViewDriver {
 public:
  /// `ticks` are those of the data set, two or more.
  explicit ScrubDriver(int64_t ticks) : ticks_(ticks) {}
  bool after_frame(const view::ScriptHost& host) override;
  double ticks_per_s() const { return rate(first_); }        ///< each for the first time
  double ticks_per_s_again() const { return rate(again_); }  ///< those that the viewer may have kept
  size_t panels() const { return panels_; }

 private:
  struct Pass {
    int64_t ticks = 0;
    double seconds = 0.0;
  };
  static double rate(const Pass& pass) { return static_cast<double>(pass.ticks) / pass.seconds; }
  void open_panels(const view::ScriptHost& host);

  const int64_t ticks_;
  bool opened_ = false;
  int waited_ = 0;
  size_t panels_ = 0;
  std::shared_ptr<const view::ShownTick> before_;
  bool backwards_ = false;
  Clock::time_point begin_;
  Pass first_, again_;
};

}  // namespace greatx::apps
