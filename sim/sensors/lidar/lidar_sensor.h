// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <memory>

#include "renderer/lidar/lidar_pass.h"
#include "sim/experiment/experiment.h"
#include "sim/sensors/sensor.h"

namespace greatx::sim {

/// A LiDAR on a node. Each shot starts from the pose at its own time, and meets the bodies in their poses at
/// that time.
class LidarSensor : public Sensor {
 public:
  LidarSensor(scene::GpuScene& gpu_scene, const Experiment& experiment, uint32_t node, uint32_t sensor);

  const SensorSpec& spec() const override { return spec_; }
  void record(gpu::TickSlot& slot, const TickContext& context) override;
  std::vector<Array> collect(const gpu::TickSlot& slot) override;
  Evidence evidence() const override;

  /// Returns the sweep collected last.
  const render::LidarScan& scan() const { return scan_; }

 private:
  struct Sweep {
    render::LidarPass::Pending pending;
    render::ShotNoise noise;
  };
  void describe(const SensorConfig& sensor);
  /// Returns whether returns may be compared with pictures of the tick: all shots are at the tick, along the
  /// axis of the beam.
  bool exact() const;
  std::vector<Pose> poses(const TickContext& context, const render::ScanPattern& pattern) const;
  render::ShotNoise noise_of(const TickContext& context) const;

  const World& world_;
  const LidarConfig& config_;
  uint32_t node_;
  uint64_t seed_;
  Pose mount_;
  bool per_shot_;
  uint32_t unseen_body_;  ///< a body that the beams pass through, with its parts; 0: none
  render::LidarPass pass_;
  SensorSpec spec_;
  std::array<Sweep, slots_in_flight> sweeps_;
  render::LidarScan scan_;
};

}  // namespace greatx::sim
