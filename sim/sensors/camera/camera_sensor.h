// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <memory>
#include <vector>

#include "renderer/camera/camera.h"
#include "renderer/camera/truth.h"
#include "renderer/probe/probe.h"
#include "sim/scenario/clock.h"
#include "sim/sensors/camera/boxes.h"
#include "sim/sensors/sensor.h"
#include "sim/world/posed_scene.h"

namespace greatx::sim {

/// Holds the poses of a camera and of all bodies at one instant, local coordinates.
struct TruthMoment {
  Pose local_from_sensor;
  std::vector<Pose> bodies;
};

/// A camera on a node. With a probe pass, the depth of each picture is compared with rays through pixel
/// centres.
class CameraSensor : public Sensor {
 public:
  /// `node` and `sensor` are indices into the scenario. `probe` may be null. All others outlive this.
  CameraSensor(PosedScene& posed, const render::ProbePass* probe, const Scenario& scenario, uint32_t node,
               uint32_t sensor);

  const SensorSpec& spec() const override { return spec_; }
  void record(gpu::TickSlot& slot, const TickContext& context) override;
  std::vector<Array> collect(const gpu::TickSlot& slot) override;
  Evidence evidence() const override;
  bool draws_pictures() const override { return true; }
  /// An event camera that shares the pixels needs the pictures before a resumed tick, too.
  bool remembers() const override { return pass_.desc().outputs.luminance; }

  /// Returns the camera pass, which holds the picture recorded last.
  render::CameraPass& pass() { return pass_; }

 private:
  void expose(gpu::TickSlot& slot, const TickContext& context, const Pose& local_from_sensor);
  void expose_rows(gpu::TickSlot& slot, const TickContext& context);
  void describe(const CameraConfig& config, size_t instances);
  void check(const gpu::TickSlot& slot);
  /// Returns the moment at which the camera fires next. After the last sample of a sequence the trajectories
  /// continue as defined by Course.
  TruthMoment next_sample(const TickContext& context) const;

  PosedScene& posed_;
  const World& world_;
  CameraConfig config_;
  uint32_t node_;
  Pose mount_;
  Clock clock_;
  SampleTimes times_;
  SensorSpec spec_;
  render::CameraPass pass_;
  std::unique_ptr<render::TruthPass> truth_;  ///< null if no output asks for it
  std::unique_ptr<Boxes> boxes_;              ///< null without boxes
  std::vector<int32_t> node_of_body_;
  std::array<TruthMoment, slots_in_flight> moments_;  ///< poses at the ticks in flight, for boxes
  const render::ProbePass* probe_;
  std::vector<glm::uvec2> probe_pixels_;
  std::array<gpu::Slice, slots_in_flight> probe_hits_;
  render::CameraImages images_;
  ErrorStatistics depth_errors_;  ///< errors of the picture collected last
};

}  // namespace greatx::sim
