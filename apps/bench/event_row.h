// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// A row of `greatx bench --camera`: what one interval of an event camera costs.
#pragma once

#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "gpu/tick_ring.h"
#include "renderer/camera/camera.h"
#include "renderer/event/event_pass.h"

namespace greatx::apps {

/// Where the camera and everything else is at one picture.
struct Instant {
  Pose local_from_sensor;
  std::vector<Pose> bodies;
};

/// The view of `desc` as an event camera with its defaults sees it: luminance pictures at even sub-steps, all
/// in one submission, from recording to the sorted list of events.
class EventRow {
 public:
  static constexpr uint32_t substeps = 4;
  static constexpr int64_t interval_ns = 33'333'333;  ///< of a camera of 30 Hz

  /// `lighting`, its scene and `gpu_scene`, which is that scene, outlive this.
  EventRow(std::string name, scene::GpuScene& gpu_scene, render::SceneLighting& lighting,
           render::CameraDesc desc);
  /// The picture that the interval begins with, then, counted, those of its sub-steps: `substeps` + 1
  /// instants.
  void shoot(const std::vector<Instant>& instants, bool counts);
  /// As the other rows of the bench, and `events`: on average.
  nlohmann::json result() const;

 private:
  void take(gpu::TickSlot& slot, uint32_t index, const Instant& instant);

  std::string name_;
  scene::GpuScene& gpu_;
  render::SceneLighting& lighting_;
  render::CameraPass camera_;
  render::EventPass events_;
  gpu::TickRing ring_;
  std::vector<double> times_, cpu_;
  uint64_t found_ = 0;
};

}  // namespace greatx::apps
