// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Makes what radars and channels know of the scene on a thread of its own, while the caller sets up the
// device's passes. It takes a third of a city's set-up and uses the host alone.
#pragma once

#include <atomic>
#include <deque>
#include <functional>
#include <future>
#include <memory>
#include <mutex>
#include <thread>
#include <utility>

#include "scene/description/wedges.h"
#include "scene/device/gpu_scene.h"
#include "sim/channel/channel_paths.h"
#include "sim/experiment/experiment.h"
#include "sim/sensors/sensor.h"

namespace greatx::sim {

class RadioAhead {
 public:
  /// Begins. On one core, everything is made when it is asked for. The scene and the experiment outlive this.
  RadioAhead(scene::GpuScene& gpu_scene, const Experiment& experiment);
  /// Leaves out what is not begun and waits for the rest.
  ~RadioAhead();
  RadioAhead(const RadioAhead&) = delete;
  RadioAhead& operator=(const RadioAhead&) = delete;

  /// Returns the radar at a place, once; null if it has passes on the device. Throws its errors.
  std::unique_ptr<Sensor> radar(SensorPlace at);
  /// Returns the world of a channel, once. Throws its errors.
  std::shared_ptr<RadioWorld> world(uint32_t channel);
  /// Returns the survey of the edges that radars and channels share; null if fewer than two need it.
  const scene::EdgeSurvey* survey();

 private:
  template <typename Made>
  struct Task {
    explicit Task(std::function<Made()> work) : make(std::move(work)), made(make.get_future()) {}
    std::packaged_task<Made()> make;
    std::future<Made> made;
  };
  struct Radar {
    SensorPlace at;
    Task<std::unique_ptr<Sensor>> task;
  };
  template <typename Made>
  Made take(Task<Made>& task);
  void run();

  const Experiment& experiment_;
  bool surveys_ = false;
  std::once_flag surveyed_;
  std::unique_ptr<const scene::EdgeSurvey> survey_;
  std::deque<Radar> radars_;
  std::deque<Task<std::shared_ptr<RadioWorld>>> worlds_;  ///< [channels]
  std::atomic<bool> stop_{false};
  std::thread thread_;  ///< not joinable on one core
};

}  // namespace greatx::sim
