// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "sim/run/sensor_places.h"

#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include "sim/world/solids.h"

namespace greatx::sim {

std::string within(const World& world, const dvec3& point, std::span<const Pose> body_poses,
                   uint32_t own_body) {
  const Solids& solids = world.solids();
  const rf::Placement placement = solids.surfaces().of(point, body_poses, own_body);
  if (placement.solid != rf::Placement::none)
    return fmt::format("inside '{}'", solids.object_of(placement.solid));
  if (placement.beneath != rf::Placement::none)
    return fmt::format("beneath '{}'", solids.object_of(placement.beneath));
  return "";
}

SensorPlaces::SensorPlaces(const Scenario& scenario, const World& world) : world_(world) {
  for (uint32_t node = 0; node < scenario.nodes.size(); ++node)
    for (const SensorConfig& sensor : scenario.nodes[node].sensors) {
      if (std::holds_alternative<AntennaConfig>(sensor.config)) continue;
      Place& place = places_[scenario.nodes[node].name + "/" + sensor.name];
      place.node = node;
      place.body = world.body_of_node[node];
      place.mount = sensor.mount.position_m;
      place.rests = std::holds_alternative<StaticTrajectory>(scenario.nodes[node].trajectory);
    }
}

void SensorPlaces::look(const std::string& name, const TickContext& context) {
  const auto found = places_.find(name);
  if (found == places_.end()) return;
  Place& place = found->second;
  if (!place.rests || place.looked_in != context.sequence) {
    const dvec3 point = world_.scene.to_local(context.nodes[place.node].pose.apply(place.mount));
    const std::string what = within(world_, point, context.body_poses, place.body);
    place.looked_in = context.sequence;
    place.was_inside = !what.empty();
    if (place.was_inside && place.first.empty()) {
      place.first = fmt::format("{} at tick {} of sequence {}", what, context.tick, context.sequence);
      spdlog::warn("{}: is {}", name, place.first);
    }
  }
  ++place.records;
  place.inside += place.was_inside;
}

void SensorPlaces::count(std::map<std::string, uint64_t>& counters) const {
  for (const auto& [name, place] : places_)
    if (place.inside > 0) counters[name + ".records_inside_solids"] = place.inside;
}

void SensorPlaces::warn(std::vector<std::string>& warnings) const {
  for (const auto& [name, place] : places_)
    if (place.inside > 0)
      warnings.push_back(fmt::format("{}: {} of {} records are taken within something, first {}", name,
                                     place.inside, place.records, place.first));
}

}  // namespace greatx::sim
