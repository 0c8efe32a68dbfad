// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "sim/channel/channel_targets.h"

#include <algorithm>

#include <fmt/format.h>

#include "core/hash.h"
#include "core/units.h"
#include "rf/targets/echo_path.h"
#include "rf/targets/surface_target.h"

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
                               uint32_t channel, const rf::ChannelGrid& grid)
    : experiment_(experiment),
      radio_(radio),
      leg_config_(config_of_legs(experiment.scenario.channels[channel])),
      of_target_(experiment.scene().bodies.size(), false) {
  for (const TargetConfig& target : leg_config_.targets) {
    targets_.push_back(make_target(target, experiment.scenario.seed));
    if (targets_.back().model != nullptr || targets_.back().surface != nullptr)
      points_.push_back(targets_.size() - 1);
  }
  for (uint32_t body = 1; body < of_target_.size(); ++body)
    for (const Target& target : targets_)
      if (experiment.scene().owner_of(body) == target.centre.body) of_target_[body] = true;
  make_legs(gpu_scene, crossings);
  if (points_.size() < targets_.size()) make_tubes(gpu_scene, grid);
}

void ChannelTargets::make_legs(scene::GpuScene& gpu_scene, rf::CrossingPass& crossings) {
  std::vector<ChannelEnd> centres;
  for (const size_t point : points_) centres.push_back(targets_[point].centre);
  std::vector<std::string> names;
  for (const auto* list : {&leg_config_.transmitters, &leg_config_.receivers})
    for (const std::string& name : *list) {
      const auto known = static_cast<size_t>(std::ranges::find(names, name) - names.begin());
      (list == &leg_config_.transmitters ? transmitters_ : receivers_).push_back(known);
      if (known < names.size()) continue;
      names.push_back(name);
      End& end = ends_.emplace_back();
      end.node = sensor_place(experiment_.scenario, name).node;
      end.number = mix64(uint64_t{fnv1a32(name)} << 32 | name.size());
      if (points_.empty()) continue;
      end.legs =
          std::make_unique<ChannelPaths>(gpu_scene, crossings, experiment_, radio_, leg_config_,
                                         ChannelEnds{antenna_end(experiment_, name), centres, false, false});
    }
}

/// All targets of tubes share one search, with the finest tubes and the most bounces that one of them asks
/// for.
void ChannelTargets::make_tubes(scene::GpuScene& gpu_scene, const rf::ChannelGrid& grid) {
  std::vector<TubeTarget> targets;
  TargetTubes all{.tube_m = 1e9, .budget = 0, .max_bounces = 1};
  for (size_t i = 0; i < targets_.size(); ++i) {
    const auto* tubes = std::get_if<TargetTubes>(&leg_config_.targets[i].model);
    if (tubes == nullptr) continue;
    targets.push_back({targets_[i].instance, leg_config_.targets[i].node});
    all.tube_m = std::min(all.tube_m, tubes->tube_m);
    all.budget = std::min(4'000'000u, all.budget + tubes->budget);
    all.max_bounces = std::max(all.max_bounces, tubes->max_bounces);
  }
  tubes_ = std::make_unique<TubeEchoes>(gpu_scene, experiment_, leg_config_, radio_->model().surfaces, grid,
                                        std::move(targets), all);
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
  } else if (const auto* table = std::get_if<std::shared_ptr<const rf::RcsTable>>(&config.model)) {
    target.model = table->get();
  } else if (const auto* surface = std::get_if<TargetSurface>(&config.model)) {
    target.surface = surface;
    if (surface->steer)
      for (const SurfaceEnd* end : {&surface->steer->first, &surface->steer->second})
        target.aims.push_back(end->antenna.empty() ? ChannelEnd{} : antenna_end(experiment_, end->antenna));
  }
  return target;
}

/// Sets the phases of a panel for the places of its ends at a tick.
std::shared_ptr<const rf::TargetModel> ChannelTargets::surface_at(const Target& target,
                                                                  const rf::EndState& centre,
                                                                  const TickContext& context) const {
  const TargetSurface& surface = *target.surface;
  const double wavelength_m = speed_of_light / leg_config_.carrier_hz;
  const rf::SurfaceLayout layout{surface.rows, surface.columns, surface.row_spacing_wl * wavelength_m,
                                 surface.column_spacing_wl * wavelength_m, wavelength_m};
  std::vector<double> phases(layout.elements(), surface.phase);
  if (!surface.phases.empty()) phases = surface.phases;
  if (surface.steer) {
    const auto aim = [&](const SurfaceEnd& end, const ChannelEnd& antenna) -> rf::SurfaceAim {
      if (end.antenna.empty()) return {end.direction};
      const dvec3 towards = glm::conjugate(centre.orientation) *
                            (state_of(antenna, *experiment_.world, context).position - centre.position);
      const double distance_m = glm::length(towards);
      return distance_m > 0.0 ? rf::SurfaceAim{towards / distance_m, distance_m} : rf::SurfaceAim{};
    };
    phases = rf::steered_phases(layout, aim(surface.steer->first, target.aims[0]),
                                aim(surface.steer->second, target.aims[1]));
  }
  if (surface.bits > 0) rf::round_phases(phases, surface.bits);
  return std::make_shared<const rf::SurfaceTarget>(layout, phases, surface.amplitude);
}

void ChannelTargets::start(const TickContext& context) {
  for (End& end : ends_)
    if (end.legs) end.legs->start(context);
}

bool ChannelTargets::looks_ahead() const {
  return std::ranges::any_of(ends_, [](const End& end) { return end.legs && end.legs->looks_ahead(); });
}

void ChannelTargets::record_ahead(gpu::TickSlot& slot, const TickContext& next) {
  for (End& end : ends_)
    if (end.legs) end.legs->record_ahead(slot, next);
}

void ChannelTargets::record(gpu::TickSlot& slot, const TickContext& context) {
  for (End& end : ends_)
    if (end.legs) end.legs->record(slot, context);
  if (tubes_) tubes_->record(slot, context);
  std::vector<TargetState>& states = states_in_flight_[slot.index];
  states.clear();
  for (const Target& target : targets_) {
    states.push_back({target.instance, *target.centre.node,
                      state_of(target.centre, *experiment_.world, context), nullptr});
    if (target.surface != nullptr) states.back().surface = surface_at(target, states.back().centre, context);
  }
  sequence_in_flight_[slot.index] = context.sequence;
}

void ChannelTargets::collect(const gpu::TickSlot& slot) {
  for (End& end : ends_) {
    if (!end.legs) continue;
    end.solved = end.legs->collect(slot);
    for (ChannelPaths::Link& link : end.solved.links)
      std::erase_if(link.paths, [this](const rf::Path& leg) { return touches_target(leg); });
  }
  if (tubes_) tubes_->collect(slot);
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

void ChannelTargets::add_echoes_of(size_t point, const End& from, const End& to,
                                   std::vector<rf::Path>& paths) {
  const Target& target = targets_[points_[point]];
  const TargetState& state = states_[points_[point]];
  const rf::EndState& centre = state.centre;
  const rf::TargetModel& model = state.surface ? *state.surface : *target.model;
  for (const rf::Path& back : to.solved.links[point].paths) {
    const rf::Path home = rf::reversed(back);
    for (const rf::Path& out : from.solved.links[point].paths) {
      const rf::EchoKey key{number_of_leg(from.number, out), number_of_leg(to.number, back), sequence_};
      const rf::ScatterMatrix s = rf::scatter_in_world(
          model, centre.orientation,
          {out.arrival, home.departure, rf::sphere_of_leg(out), rf::sphere_of_leg(home)}, key);
      paths.push_back(rf::echo_path(out, home, target.instance, s));
    }
  }
}

void ChannelTargets::add_echoes(uint32_t transmitter, size_t receiver, std::vector<rf::Path>& paths) {
  replaced_ += std::erase_if(paths, [this](const rf::Path& path) { return touches_target(path); });
  const End &from = ends_[transmitters_[transmitter]], &to = ends_[receivers_[receiver]];
  const size_t before = paths.size();
  for (size_t point = 0; point < points_.size(); ++point) {
    const uint32_t node = states_[points_[point]].node;
    if (node != from.node && node != to.node) add_echoes_of(point, from, to, paths);
  }
  if (tubes_) tubes_->add_echoes(transmitter, receiver, paths);
  echoes_ += paths.size() - before;
  std::sort(paths.begin(), paths.end(), [](const rf::Path& a, const rf::Path& b) {
    return rf::interactions_less(a.interactions, b.interactions);
  });
}

void ChannelTargets::count(std::map<std::string, uint64_t>& counters) const {
  for (const End& end : ends_) {
    if (!end.legs) continue;
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
  for (const End& end : ends_)
    if (end.legs) all.add(end.legs->left_out());
  return all;
}

}  // namespace greatx::sim
