// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Runs one sensor of a scenario on a device for the rows of its benchmark.
#pragma once

#include <utility>

#include "gpu/tick_ring.h"
#include "sim/experiment/experiment.h"
#include "sim/plan/plan_options.h"
#include "sim/world/moment.h"

namespace greatx::apps {

/// Holds one sensor with its experiment, its scene on the GPU and its ring of ticks.
template <typename Sensor>
class SensorAlone {
 public:
  /// `device` outlives this.
  SensorAlone(gpu::Device& device, sim::Experiment experiment, const sim::SensorPlace& place)
      : experiment_(std::move(experiment)),
        gpu_(device, experiment_.scene(), sim::gpu_scene_options(experiment_.plan)),
        sensor_(gpu_, experiment_, place.node, place.sensor),
        ring_(device, 2, 4u << 20, 16u << 20) {}

  /// Records and submits the tick of `moment`, and waits until the device has finished it.
  gpu::TickSlot& trace(const sim::Moment& moment) {
    gpu::TickSlot& slot = ring_.begin();
    gpu_.record_update(slot, moment.bodies);
    sensor_.record(slot, moment.context);
    ring_.submit(slot);
    ring_.wait(slot);
    return slot;
  }
  SensorAlone(const SensorAlone&) = delete;  // the sensor refers to the experiment
  SensorAlone& operator=(const SensorAlone&) = delete;
  const sim::Scenario& scenario() const { return experiment_.scenario; }
  const sim::EffectPlan& plan() const { return experiment_.plan; }
  Sensor& sensor() { return sensor_; }
  const Sensor& sensor() const { return sensor_; }

 private:
  sim::Experiment experiment_;
  scene::GpuScene gpu_;
  Sensor sensor_;
  gpu::TickRing ring_;
};

}  // namespace greatx::apps
