// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Selects the sensor that a benchmark of one modality measures, and the moments at which it is measured.
#pragma once

#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "core/error.h"
#include "sim/scenario/clock.h"
#include "sim/scenario/scenario.h"
#include "sim/world/moment.h"
#include "sim/world/world.h"

namespace greatx::apps {

/// Returns the first sensor with a configuration of type `Config`, in the order of the scenario. Throws
/// UserError if there is none; the message names `option` ("--lidar") and `what` ("a LiDAR").
template <typename Config>
sim::SensorPlace first_sensor(const sim::Scenario& scenario, const char* option, const char* what) {
  for (uint32_t node = 0; node < scenario.nodes.size(); ++node)
    for (uint32_t sensor = 0; sensor < scenario.nodes[node].sensors.size(); ++sensor)
      if (std::holds_alternative<Config>(scenario.nodes[node].sensors[sensor].config)) return {node, sensor};
  throw_user_error("{}: bench {}: expected {}, found none", scenario.name, option, what);
}

/// Returns the scenario without channels and without sensors, except for antennas and the first sensor of
/// type `Config`. An effect plan of this scenario then considers that sensor alone. Throws like
/// first_sensor().
template <typename Config>
sim::Scenario first_sensor_alone(sim::Scenario scenario, const char* option, const char* what) {
  const sim::SensorPlace first = first_sensor<Config>(scenario, option, what);
  for (uint32_t node = 0; node < scenario.nodes.size(); ++node) {
    std::vector<sim::SensorConfig>& sensors = scenario.nodes[node].sensors;
    std::vector<sim::SensorConfig> kept;
    for (uint32_t i = 0; i < sensors.size(); ++i)
      if ((node == first.node && i == first.sensor) ||
          std::holds_alternative<sim::AntennaConfig>(sensors[i].config))
        kept.push_back(std::move(sensors[i]));
    sensors = std::move(kept);
  }
  scenario.channels.clear();
  return scenario;
}

/// Returns the moments of `count` ticks spread evenly over the first sequence.
inline std::vector<sim::Moment> moments_of(const sim::Scenario& scenario, const sim::World& world,
                                           const sim::Courses& courses, uint32_t count) {
  std::vector<sim::Moment> moments;
  for (uint32_t i = 0; i < count; ++i)
    moments.push_back(
        sim::moment_at(world, courses, sim::Clock(scenario.tick_rate_hz), scenario.ticks * i / count));
  return moments;
}

}  // namespace greatx::apps
