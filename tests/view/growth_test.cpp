// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// The real viewer for thousands of frames: it plays, scrubs, moves, opens and closes, and does not grow.
#include <algorithm>
#include <cstdlib>
#include <fstream>
#include <vector>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "core/random.h"
#include "sim/scenario/parse/load_scenario.h"
#include "view/app/script_runner.h"
#include "view/app/viewer.h"

namespace greatx::view {
namespace {

const std::string room =
    "greatx: 1\nname: test\nseed: 5\nticks: 12\ntick_rate_hz: 100\nsequences: 2\n"
    "scene: {generate: {kind: room}}\nnodes:\n"
    "  - name: bs\n    trajectory: {type: static, position_m: [-4, -3, 2.5]}\n"
    "    sensors: [{name: panel, type: antenna}]\n"
    "  - name: eye\n    trajectory: {type: waypoints, points: [{t_s: 0, position_m: [-2, 0, 1]}, {t_s: 0.12, "
    "position_m: [-1.5, 0.3, 1.2]}]}\n    model: {generate: {kind: quadrotor}}\n    sensors:\n"
    "      - {name: camera, type: camera, rate_hz: 50, width: 32, height: 24, fov_deg: 70}\n"
    "      - {name: lidar, type: lidar, rate_hz: 50, channels: 8, elevation_min_deg: -20, elevation_max_deg: "
    "20, azimuth_steps: 64}\n"
    "      - {name: antenna, type: antenna}\n"
    "channels:\n  - {name: csi, tx: bs/panel, rx: [eye/antenna], rate_hz: 50, subcarriers: 8, bandwidth_hz: "
    "20e6, max_depth: 1, rays: 2000}\n";

size_t resident_bytes() {
  std::ifstream file("/proc/self/statm");
  size_t total = 0, resident = 0;
  file >> total >> resident;
  return resident * 4096;
}

/// Does something else in each frame, as a restless person would.
class Restless {
 public:
  explicit Restless(int64_t frames) : frames_(frames) {}
  /// Returns false after the last frame.
  bool after_frame(const ScriptHost& host) {
    const RunStatus status = host.run().status();
    EXPECT_EQ(status.error, "");
    if (!status.error.empty()) return false;
    if (host.content().tick == nullptr) return true;
    act(host, frame_);
    ++frame_;
    if (frame_ >= warm_up() && (frame_ - warm_up()) % window() == 0) resident_.push_back(resident_bytes());
    return frame_ < frames_;
  }
  int64_t frames() const { return frame_; }
  /// Every panel, pass and cache has been made by then.
  int64_t warm_up() const { return frames_ / 4; }
  /// Frames between two looks at the memory.
  int64_t window() const { return (frames_ - warm_up()) / windows; }
  /// Resident bytes after the warm-up and after each window.
  const std::vector<size_t>& resident() const { return resident_; }

  static constexpr int64_t windows = 5;

 private:
  void mouse(const ScriptHost& host, InputEvent::Kind kind) {
    InputEvent event;
    event.kind = kind;
    event.x = 20.0 + 150.0 * random_.uniform();
    event.y = 40.0 + 120.0 * random_.uniform();
    host.inject(event);
  }
  void act(const ScriptHost& host, int64_t frame) {
    if (frame % 3 == 0) mouse(host, InputEvent::Kind::move);
    if (frame % 40 == 10) mouse(host, InputEvent::Kind::press);
    if (frame % 40 == 30) mouse(host, InputEvent::Kind::release);
    if (frame % 200 == 0) host.run().set_speed(frame % 400 == 0 ? 0.0 : 1.0);
    if (frame % 50 == 20) host.act("play", "");
    if (frame % 7 == 0)
      host.run().jump(static_cast<uint32_t>(frame / 7 % 2), static_cast<int64_t>(12.0 * random_.uniform()));
    if (frame % 150 == 60) host.act("show.lidar", "");
    if (frame % 170 == 60) host.act("show.boxes", "");
    if (frame % 110 == 60) host.act("side", "");
    if (frame % 130 == 60) host.act("panel", "eye/camera: depth");
    if (frame % 250 == 60) host.act("camera", frame % 500 == 60 ? "eye/camera" : "");
    if (frame % 90 == 60) host.act("outside", "");
    if (frame % 300 == 100) host.act("help", "");
  }

  const int64_t frames_;
  int64_t frame_ = 0;
  std::vector<size_t> resident_;
  RandomStream random_{7, 1, 0};
};

int64_t wanted_frames() {
  const char* const frames = std::getenv("GREATX_VIEW_FRAMES");
  return frames == nullptr ? 10'000 : std::atoll(frames);
}

TEST(Viewer, ManyFramesDoNotGrow) {
  Restless person(wanted_frames());
  ViewerOptions options;
  options.title = "test";
  options.scenario = [] { return sim::parse_scenario(room, "test.yaml", "."); };
  options.device.validation = options.window.validation = true;
  options.window.offscreen = true;
  options.window.width = 320;
  options.window.height = 240;
  options.longest_wait_s = 0.0;
  options.driver = [&](const ScriptHost& host) { return person.after_frame(host); };
  run_viewer(options);
  EXPECT_EQ(person.frames(), wanted_frames());
  ASSERT_EQ(person.resident().size(), Restless::windows + 1);
  std::vector<double> growth;  // MiB of each window
  for (size_t i = 1; i < person.resident().size(); ++i)
    growth.push_back(
        (static_cast<double>(person.resident()[i]) - static_cast<double>(person.resident()[i - 1])) /
        (1 << 20));
  RecordProperty("MiB after the warm-up", static_cast<int>(person.resident().front() >> 20));
  RecordProperty("MiB at the end", static_cast<int>(person.resident().back() >> 20));
  // A leak grows in every window. An allocator may grow once by the pages of a world, 40 MiB: threads take
  // turns in making worlds, and each takes its memory from an arena of its own, which keeps its pages. The
  // median of the windows counts, therefore. A texture of this window that is not freed takes 0.3 MiB, a
  // picture with its depth and ids 0.5 MiB; of one in fifty frames, they would be 9 MiB in a window of 1500.
  const double tolerance = 3.2e-3 * static_cast<double>(person.window());
  std::vector<double> sorted = growth;
  std::ranges::sort(sorted);
  EXPECT_LT(sorted[sorted.size() / 2], tolerance)
      << testing::PrintToString(growth) << " MiB in each window of " << person.window() << " frames";
}

}  // namespace
}  // namespace greatx::view
