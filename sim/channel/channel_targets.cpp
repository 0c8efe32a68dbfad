// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "sim/channel/channel_targets.h"

#include <algorithm>

#include <fmt/format.h>

#include "core/hash.h"
#include "rf/targets/echo_path.h"

namespace greatx::sim {

namespace {

ChannelConfig config_of_legs(const ChannelConfig& channel) {
  ChannelConfig legs = channel;
  legs.limits.max_depth = channel.legs.max_depth;
  legs.limits.max_transmissions = std::min(channel.legs.max_transmissions, channel.legs.max_depth);
  legs.limits.max_reflections_after = std::min(channel.limits.max_reflections_after, channel.legs.max_depth);
  return legs;
}

uint64_t number_of_leg(uint64_t end, const rf::Path& leg) { return mix64(end + leg.id()); }

}  // namespace

uint32_t target_instance(const Experiment& experiment, const TargetConfig& target) {
  const scene::Scene& scene = experiment.scene();
  const uint32_t body = experiment.world->body_of_node[target.node];
  for (uint32_t i = 0; body != 0 && i < scene.instances.size(); ++i)
    if (scene.owner_of(scene.instances[i].body) == body && !scene.reach_of(body).empty()) return i;
  throw_user_error_at(target.where, "targets: expected a node with surfaces, found '{}'",
                      experiment.scenario.nodes[target.node].name);
}

ChannelTargets::ChannelTargets(scene::GpuScene& gpu_scene, rf::CrossingPass& crossings,
                               const Experiment& experiment, const std::shared_ptr<RadioWorld>& radio,
                               uint32_t channel)
    : experiment_(experiment),
      radio_(radio),
      leg_config_(config_of_legs(experiment.scenario.channels[channel])),
      of_target_(experiment.scene().bodies.size(), false) {
  for (const TargetConfig& target : leg_config_.targets)
    targets_.push_back(make_target(target, experiment.scenario.seed));
  for (uint32_t body = 1; body < of_target_.size(); ++body)
    for (const Target& target : targets_)
      if (experiment.scene().owner_of(body) == target.centre.body) of_target_[body] = true;
  std::vector<ChannelEnd> centres;
  for (const Target& target : targets_) centres.push_back(target.centre);
  std::vector<std::string> names;
  for (const auto* list : {&leg_config_.transmitters, &leg_config_.receivers})
    for (const std::string& name : *list) {
      const size_t known = static_cast<size_t>(std::ranges::find(names, name) - names.begin());
      (list == &leg_config_.transmitters ? transmitters_ : receivers_).push_back(known);
      if (known < names.size()) continue;
      names.push_back(name);
      End end;
      end.node = sensor_place(experiment.scenario, name).node;
      end.number = mix64(uint64_t{fnv1a32(name)} << 32 | name.size());
      end.legs = std::make_unique<ChannelPaths>(
          gpu_scene, crossings, experiment, radio, leg_config_,
          ChannelEnds{antenna_end(experiment, name), centres, false, false});
      ends_.push_back(std::move(end));
    }
}

ChannelTargets::Target ChannelTargets::make_target(const TargetConfig& config, uint64_t seed) const {
  const NodeConfig& node = experiment_.scenario.nodes[config.node];
  Target target;
  target.instance = target_instance(experiment_, config);
  const uint32_t body = experiment_.world->body_of_node[config.node];
  const dvec3 centre = experiment_.scene().reach_of(body).center();
  target.centre = {node.name, config.node, Pose{centre, dquat(1.0, 0.0, 0.0, 0.0)}, body,
                   std::holds_alternative<StaticTrajectory>(node.trajectory)};
  if (const auto* kind = std::get_if<rf::Tr38901Kind>(&config.model)) {
    target.own = std::make_unique<rf::Tr38901Target>(*kind, seed, fnv1a32(node.name));
    target.model = target.own.get();
  } else {
    target.model = std::get<std::shared_ptr<const rf::RcsTable>>(config.model).get();
  }
  return target;
}

void ChannelTargets::start(const TickContext& context) {
  for (End& end : ends_) end.legs->start(context);
}

bool ChannelTargets::looks_ahead() const {
  return std::ranges::any_of(ends_, [](const End& end) { return end.legs->looks_ahead(); });
}

void ChannelTargets::record_ahead(gpu::TickSlot& slot, const TickContext& next) {
  for (End& end : ends_) end.legs->record_ahead(slot, next);
}

void ChannelTargets::record(gpu::TickSlot& slot, const TickContext& context) {
  for (End& end : ends_) end.legs->record(slot, context);
  std::vector<TargetState>& states = states_in_flight_[slot.index];
  states.clear();
  for (const Target& target : targets_)
    states.push_back(
        {target.instance, *target.centre.node, state_of(target.centre, *experiment_.world, context)});
  sequence_in_flight_[slot.index] = context.sequence;
}

void ChannelTargets::collect(const gpu::TickSlot& slot) {
  for (End& end : ends_) {
    end.solved = end.legs->collect(slot);
    for (ChannelPaths::Link& link : end.solved.links)
      std::erase_if(link.paths, [this](const rf::Path& leg) { return touches_target(leg); });
  }
  states_ = states_in_flight_[slot.index];
  sequence_ = sequence_in_flight_[slot.index];
}

/// Returns whether a surface of a target reflects, scatters or diffracts the path.
bool ChannelTargets::touches_target(const rf::Path& path) const {
  const scene::Scene& scene = experiment_.scene();
  return std::ranges::any_of(path.interactions, [&](const rf::Interaction& interaction) {
    switch (interaction.type) {
      case rf::InteractionType::reflection:
      case rf::InteractionType::scattering:
        return bool{of_target_[scene.facets[interaction.element].body]};
      case rf::InteractionType::diffraction:
        return bool{of_target_[scene.facets[radio_->model().wedges[interaction.element].facet_0].body]};
      default:
        return false;
    }
  });
}

void ChannelTargets::add_echoes_of(size_t target, const End& from, const End& to,
                                   std::vector<rf::Path>& paths) {
  const rf::EndState& centre = states_[target].centre;
  for (const rf::Path& back : to.solved.links[target].paths) {
    const rf::Path home = rf::reversed(back);
    for (const rf::Path& out : from.solved.links[target].paths) {
      const rf::EchoKey key{number_of_leg(from.number, out), number_of_leg(to.number, back), sequence_};
      const rf::ScatterMatrix s = rf::scatter_in_world(*targets_[target].model, centre.orientation,
                                                       {out.arrival, home.departure}, key);
      paths.push_back(rf::echo_path(out, home, targets_[target].instance, s));
    }
  }
}

void ChannelTargets::add_echoes(uint32_t transmitter, size_t receiver, std::vector<rf::Path>& paths) {
  replaced_ += std::erase_if(paths, [this](const rf::Path& path) { return touches_target(path); });
  const End &from = ends_[transmitters_[transmitter]], &to = ends_[receivers_[receiver]];
  const size_t before = paths.size();
  for (size_t target = 0; target < targets_.size(); ++target) {
    const uint32_t node = states_[target].node;
    if (node != from.node && node != to.node) add_echoes_of(target, from, to, paths);
  }
  echoes_ += paths.size() - before;
  std::sort(paths.begin(), paths.end(), [](const rf::Path& a, const rf::Path& b) {
    return rf::interactions_less(a.interactions, b.interactions);
  });
}

void ChannelTargets::count(std::map<std::string, uint64_t>& counters) const {
  for (const End& end : ends_) {
    std::map<std::string, uint64_t> own;
    end.legs->count(own);
    for (const char* name : {"paths", "candidate_overflow", "path_overflow"})
      counters[fmt::format("leg_{}", name)] += own[name];
  }
  counters["target_echoes"] = echoes_;
  counters["paths_replaced_by_echoes"] = replaced_;
}

LinkLeftOut ChannelTargets::left_out() const {
  LinkLeftOut all;
  for (const End& end : ends_) all.add(end.legs->left_out());
  return all;
}

}  // namespace greatx::sim
