// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// A row of `greatx bench --camera`: measures the time of one interval of an event camera.
#pragma once

#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "gpu/tick_ring.h"
#include "renderer/camera/camera.h"
#include "renderer/event/event_pass.h"

namespace greatx::apps {

/// Holds the poses of the camera and of all bodies at the time of one picture.
struct Instant {
  Pose local_from_sensor;
  std::vector<Pose> bodies;
};

/// Returns the camera that makes the pictures of an event camera with the same view.
render::CameraDesc luminance_camera(render::CameraDesc desc);
/// Returns an event camera with the pixels of `camera` and room for sixteen events a pixel.
render::EventDesc event_camera(const std::string& name, const render::CameraDesc& camera, uint32_t substeps);

/// Measures an event camera with default settings and the view of `desc`. It renders luminance pictures at
/// equally spaced sub-steps in one submission. The measured time runs from the recording of the commands to
/// the sorted list of events.
class EventRow {
 public:
  static constexpr uint32_t substeps = 4;
  static constexpr int64_t interval_ns = 33'333'333;  ///< interval of a camera of 30 Hz

  /// `gpu_scene` is the scene of `lighting`. Both outlive this.
  EventRow(std::string name, scene::GpuScene& gpu_scene, render::SceneLighting& lighting,
           render::CameraDesc desc);
  /// Renders one interval, given by `substeps` + 1 instants: the picture at its beginning, then the pictures
  /// of its sub-steps. Only the sub-steps are measured. If `counts` is false, nothing is added to the result.
  void shoot(const std::vector<Instant>& instants, bool counts);
  /// Returns the fields of the other rows of the bench, and `events`, the average number of events.
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
