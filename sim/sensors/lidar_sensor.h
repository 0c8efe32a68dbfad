// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>

#include "renderer/lidar.h"
#include "sim/plan/effect_plan.h"
#include "sim/sensors/sensor.h"
#include "sim/world.h"

namespace greatx::sim {

/// A LiDAR on a node: each shot from the pose at its own time.
class LidarSensor : public Sensor {
 public:
  LidarSensor(scene::GpuScene& gpu_scene, const EffectPlan& plan, const Scenario& scenario,
              const World& world, uint32_t node, uint32_t sensor);

  const SensorSpec& spec() const override { return spec_; }
  void record(gpu::TickSlot& slot, const TickContext& context) override;
  std::vector<Array> collect(const gpu::TickSlot& slot) override;

  uint32_t node() const { return node_; }
  const Pose& mount() const { return mount_; }
  /// All shots at the tick: returns may be compared with pictures of that tick.
  bool instantaneous() const { return !per_shot_; }
  /// The sweep collected last.
  const render::LidarScan& scan() const { return scan_; }

 private:
  void describe();

  const World& world_;
  uint32_t node_;
  Pose mount_;
  bool per_shot_;
  render::LidarPass pass_;
  SensorSpec spec_;
  std::array<render::LidarPass::Pending, slots_in_flight> pending_;
  render::LidarScan scan_;
};

}  // namespace greatx::sim
