// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "sim/scenario/scenario.h"

#include "core/error.h"

namespace greatx::sim {

std::optional<SensorPlace> find_sensor(const std::vector<NodeConfig>& nodes, const std::string& name) {
  for (uint32_t node = 0; node < nodes.size(); ++node)
    for (uint32_t sensor = 0; sensor < nodes[node].sensors.size(); ++sensor)
      if (nodes[node].name + "/" + nodes[node].sensors[sensor].name == name) return SensorPlace{node, sensor};
  return std::nullopt;
}

SensorPlace sensor_place(const Scenario& scenario, const std::string& name) {
  const std::optional<SensorPlace> place = find_sensor(scenario.nodes, name);
  GREATX_CHECK(place.has_value(), "no sensor '{}', which the parser let pass", name);
  return *place;
}

}  // namespace greatx::sim
