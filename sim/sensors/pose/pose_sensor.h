// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <optional>

#include "core/geodesy.h"
#include "scene/description/scene.h"
#include "sim/sensors/sensor.h"

namespace greatx::sim {

/// Delivers the ground truth of the motion of all nodes, and of the lamps that switch, whenever another
/// sensor fires.
class PoseSensor : public Sensor {
 public:
  /// If the scene has a georeference, each record also has the places of the nodes on the Earth.
  PoseSensor(const Scenario& scenario, const scene::Scene& scene);
  const SensorSpec& spec() const override { return spec_; }
  void record(gpu::TickSlot& slot, const TickContext& context) override;
  std::vector<Array> collect(const gpu::TickSlot& slot) override;
  Evidence evidence() const override;

 private:
  SensorSpec spec_;
  std::optional<LocalFrame> frame_;
  size_t lamps_ = 0;  ///< that switch
  std::array<std::vector<Array>, slots_in_flight> arrays_;
};

}  // namespace greatx::sim
