// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Lets the traffic of a scenario move on the streets of its scene.
#pragma once

#include <memory>
#include <vector>

#include "scene/gltf/model.h"
#include "sim/scenario/trajectory.h"
#include "sim/world/world.h"

namespace greatx::sim {

/// Returns the streets of an object of the scene, or nothing if it has none, for the traffic of a scenario.
/// Throws UserError if the object is scaled, or if the streets do not fit together.
std::shared_ptr<const Streets> streets_of(const Scenario& scenario, const scene::Model& model,
                                          const StaticObject& object);

/// Checks that the scene has streets, and that they have room for the scenario's traffic.
void check_traffic(const Scenario& scenario, const World& world);

class WorldTraffic : public TrafficSource {
 public:
  /// Both outlive this, and world.streets the courses.
  WorldTraffic(const Scenario& scenario, const World& world) : scenario_(scenario), world_(world) {}
  std::vector<std::unique_ptr<Course>> courses(uint32_t sequence) const override;

 private:
  const Scenario& scenario_;
  const World& world_;
};

}  // namespace greatx::sim
