// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Makes what radars and channels know of the scene on a thread of its own, while the caller uploads the scene
// and sets up the device's passes. It takes a third of a city's set-up and uses the host alone.
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
  /// Begins with what needs no device. On one core, everything is made when it is asked for. The experiment
  /// outlives this.
  RadioAhead(const gpu::Device& device, const Experiment& experiment);
  /// Begins the radars, which keep a reference to the scene on the device, and returns that scene. Called
  /// once, before radar().
  scene::GpuScene& begin_radars(scene::GpuScene& gpu_scene);
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
  std::promise<scene::GpuScene*> uploaded_;  ///< null if the upload failed
  std::shared_future<scene::GpuScene*> gpu_scene_;
  bool begun_ = false;  ///< uploaded_ has its value
  bool surveys_ = false;
  std::once_flag surveyed_;
  std::unique_ptr<const scene::EdgeSurvey> survey_;
  std::deque<Radar> radars_;
  std::deque<Task<std::shared_ptr<RadioWorld>>> worlds_;  ///< [channels]
  std::atomic<bool> stop_{false};
  std::thread thread_;  ///< not joinable on one core
};

}  // namespace greatx::sim
