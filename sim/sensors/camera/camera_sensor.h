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

/// Where a camera and all bodies are at one instant, local coordinates.
struct TruthMoment {
  Pose local_from_sensor;
  std::vector<Pose> bodies;
};

/// A camera on a node. With a probe pass, each picture's depth is held against rays through pixel centres.
class CameraSensor : public Sensor {
 public:
  /// `node`, `sensor`: indices into the scenario. `probe` may be null; the others outlive this.
  CameraSensor(PosedScene& posed, const render::ProbePass* probe, const Scenario& scenario, uint32_t node,
               uint32_t sensor);

  const SensorSpec& spec() const override { return spec_; }
  void record(gpu::TickSlot& slot, const TickContext& context) override;
  std::vector<Array> collect(const gpu::TickSlot& slot) override;
  Evidence evidence() const override;
  bool draws_pictures() const override { return true; }
  /// An event camera that shares its pixels looks at the pictures before a resume, too.
  bool remembers() const override { return pass_.desc().outputs.luminance; }

  /// With the picture recorded last.
  const render::CameraPass& pass() const { return pass_; }

 private:
  void expose(gpu::TickSlot& slot, const TickContext& context, const Pose& local_from_sensor);
  void describe(const CameraConfig& config, size_t instances);
  void check(const gpu::TickSlot& slot);
  /// When the camera fires next; after a sequence's last sample the trajectories go on as Course has it.
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
  std::unique_ptr<Boxes> boxes_;              ///< likewise
  std::vector<int32_t> node_of_body_;
  std::array<TruthMoment, slots_in_flight> moments_;  ///< of the ticks in flight, for boxes
  const render::ProbePass* probe_;
  std::vector<glm::uvec2> probe_pixels_;
  std::array<gpu::Slice, slots_in_flight> probe_hits_;
  render::CameraImages images_;
  ErrorStatistics depth_errors_;  ///< of the picture collected last
};

}  // namespace greatx::sim
