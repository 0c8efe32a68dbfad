// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "sim/channel_notes.h"

#include <algorithm>

#include "sim/channel_paths.h"
#include "sim/channel_search.h"

namespace greatx::sim {

namespace {

/// The node of an antenna called "node/sensor".
uint32_t node_of(const Scenario& scenario, const std::string& antenna) {
  for (uint32_t node = 0; node < scenario.nodes.size(); ++node)
    for (const SensorConfig& sensor : scenario.nodes[node].sensors)
      if (scenario.nodes[node].name + "/" + sensor.name == antenna) return node;
  throw ContractError(fmt::format("no antenna '{}', which the parser let pass", antenna));
}

}  // namespace

std::vector<std::pair<std::string, std::string>> channel_notes(const Scenario& scenario, const World& world,
                                                               const EffectPlan& plan, uint32_t channel) {
  const ChannelConfig& config = scenario.channels[channel];
  const auto rests = [&](const std::string& antenna) {
    return std::holds_alternative<StaticTrajectory>(scenario.nodes[node_of(scenario, antenna)].trajectory);
  };
  const ChannelSearch::Ends ends{rests(config.transmitter),
                                 std::all_of(config.receivers.begin(), config.receivers.end(), rests),
                                 world.body_of_node[node_of(scenario, config.transmitter)]};
  // No note speaks of edges, and finding them takes a while.
  rf::RadioEffects effects = radio_effects(plan, scenario);
  effects.diffraction = false;
  const rf::RadioModel model(world.scene, config.carrier_hz, effects);
  return ChannelSearch(nullptr, model, plan, config, ends).notes();
}

}  // namespace greatx::sim
