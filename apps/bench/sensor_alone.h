// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// One sensor of a scenario on a device, with everything it needs, for the rows of its benchmark.
#pragma once

#include <memory>
#include <utility>

#include "gpu/tick_ring.h"
#include "sim/plan/plan_options.h"
#include "sim/scenario/scenario.h"
#include "sim/world/moment.h"
#include "sim/world/world.h"

namespace greatx::apps {

template <typename Sensor>
class SensorAlone {
 public:
  /// `world` fits the scenario and outlives this, as the device does.
  SensorAlone(gpu::Device& device, sim::Scenario scenario, const sim::World& world,
              const sim::SensorPlace& place)
      : scenario_(std::make_unique<sim::Scenario>(std::move(scenario))),
        plan_(sim::make_effect_plan(*scenario_, world.scene)),
        gpu_(device, world.scene, sim::gpu_scene_options(plan_)),
        sensor_(gpu_, plan_, *scenario_, world, place.node, place.sensor),
        ring_(device, 2, 4u << 20, 16u << 20) {}

  /// Records the moment's tick, and waits until the device is done with it.
  gpu::TickSlot& trace(const sim::Moment& moment) {
    gpu::TickSlot& slot = ring_.begin();
    gpu_.record_update(slot, moment.bodies);
    sensor_.record(slot, moment.context);
    ring_.submit(slot);
    ring_.wait(slot);
    return slot;
  }
  const sim::Scenario& scenario() const { return *scenario_; }
  const sim::EffectPlan& plan() const { return plan_; }
  Sensor& sensor() { return sensor_; }
  const Sensor& sensor() const { return sensor_; }

 private:
  std::unique_ptr<sim::Scenario> scenario_;  ///< in its place, since the sensor refers to it
  sim::EffectPlan plan_;
  scene::GpuScene gpu_;
  Sensor sensor_;
  gpu::TickRing ring_;
};

}  // namespace greatx::apps
