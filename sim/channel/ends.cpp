// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "sim/channel/ends.h"

#include <cmath>
#include <string_view>
#include <tuple>

#include <fmt/format.h>

namespace greatx::sim {

ChannelEnd antenna_end(const Experiment& experiment, const std::string& name) {
  const Scenario& scenario = experiment.scenario;
  const auto [node, sensor] = sensor_place(scenario, name);
  const NodeConfig& config = scenario.nodes[node];
  ChannelEnd end{name, node, mount_pose(config.sensors[sensor].mount), experiment.world->body_of_node[node]};
  const auto& antenna = std::get<AntennaConfig>(config.sensors[sensor].config);
  end.elements = antenna.elements_wl.empty() ? antenna.rows * antenna.columns
                                             : static_cast<uint32_t>(antenna.elements_wl.size());
  const auto* place = std::get_if<StaticTrajectory>(&config.trajectory);
  end.rests = place != nullptr;
  if (!end.rests) return end;
  const dvec3& turn = place->rotation;
  const dquat orientation = orientation_from_yaw_pitch_roll(turn.x, turn.y, turn.z);
  end.height_mm = std::llround(1e3 * (place->position_m + orientation * end.mount.position).z);
  return end;
}

ChannelEnd point_end(const dvec3& point, size_t number) {
  return {fmt::format("point {}", number), std::nullopt, Pose{point, dquat(1.0, 0.0, 0.0, 0.0)}, 0, true};
}

rf::Source searched_from(const ChannelEnd& transmitter, const ChannelEnd& receiver) {
  const auto rank = [](const ChannelEnd& end) {
    return std::tuple(!end.rests, -int64_t{end.elements}, -end.height_mm, std::string_view(end.name));
  };
  return rank(receiver) < rank(transmitter) ? rf::Source::receiver : rf::Source::transmitter;
}

ChannelEnds channel_ends(const Experiment& experiment, uint32_t channel, uint32_t transmitter) {
  const ChannelConfig& config = experiment.scenario.channels[channel];
  ChannelEnds ends;
  ends.transmitter = antenna_end(experiment, config.transmitters[transmitter]);
  for (const std::string& name : config.receivers) ends.receivers.push_back(antenna_end(experiment, name));
  ends.check_receivers = transmitter == 0;
  return ends;
}

rf::EndState state_of(const ChannelEnd& end, const World& world, const TickContext& context) {
  rf::EndState state;
  if (!end.node) {
    const Pose pose = world.scene.to_local(end.mount);
    state.position = pose.position;
    state.orientation = pose.orientation;
    return state;
  }
  const Motion& node = context.nodes[*end.node];
  const Pose pose = world.scene.to_local(node.pose) * end.mount;
  state.position = pose.position;
  state.velocity = node.velocity + glm::cross(node.angular_velocity, node.pose.rotate(end.mount.position));
  state.orientation = pose.orientation;
  state.body = end.body;
  return state;
}

dvec3 world_position(const ChannelEnd& end, const TickContext& context) {
  return end.node ? (context.nodes[*end.node].pose * end.mount).position : end.mount.position;
}

}  // namespace greatx::sim
