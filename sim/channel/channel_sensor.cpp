// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "sim/channel/channel_sensor.h"

#include <algorithm>
#include <cmath>

#include <spdlog/spdlog.h>

#include "core/budget.h"
#include "core/built_effects.h"
#include "core/units.h"
#include "sim/plan/antennas.h"
#include "sim/plan/array_plan.h"

namespace greatx::sim {

namespace {

std::vector<rf::AntennaArray> arrays_called(const std::vector<std::string>& names, const char* end,
                                            const Scenario& scenario, const ChannelConfig& config) {
  std::vector<rf::AntennaArray> arrays;
  for (const std::string& name : names) arrays.push_back(antenna_array(scenario, name, config.carrier_hz));
  for (const rf::AntennaArray& array : arrays)
    if (array.port_count() != arrays[0].port_count())
      throw_user_error_at(config.where,
                          "channel '{}': {}: expected antennas with one number of ports, found {} and {}; "
                          "give each its own channel",
                          config.name, end, arrays[0].port_count(), array.port_count());
  return arrays;
}

}  // namespace

ChannelSensor::ChannelSensor(scene::GpuScene& gpu_scene, rf::CrossingPass& crossings,
                             const Experiment& experiment, uint32_t channel,
                             std::shared_ptr<RadioWorld> radio)
    : gpu_scene_(gpu_scene),
      crossings_(crossings),
      experiment_(experiment),
      channel_(channel),
      config_(experiment.scenario.channels[channel]),
      doppler_(experiment.plan.doppler.on),
      radio_(std::move(radio)),
      transmitter_arrays_(arrays_called(config_.transmitters, "tx", experiment.scenario, config_)),
      receiver_arrays_(arrays_called(config_.receivers, "rx", experiment.scenario, config_)) {
  for (uint32_t t = 0; t < config_.transmitters.size(); ++t)
    paths_.push_back(std::make_unique<ChannelPaths>(gpu_scene, crossings, experiment, radio_, channel,
                                                    channel_ends(experiment, channel, t)));
  grid_ = channel_grid(config_, experiment.plan);
  if (all_effects_built && experiment.plan.target_echoes.on && !config_.targets.empty())
    targets_ = std::make_unique<ChannelTargets>(gpu_scene, crossings, experiment, radio_, channel, grid_);
  if (all_effects_built && experiment.plan.dispersion.on)
    dispersion_.emplace(experiment.scene(), radio_->model().field_model(), radio_->model().effects.weather,
                        grid_);
  if (all_effects_built && experiment.plan.every_element.on) find_near_links();
  if (all_effects_built && experiment.plan.sensing.on && config_.sensing)
    sensing_ = std::make_unique<ChannelSensing>(experiment, config_, grid_, transmitter_arrays_,
                                                receiver_arrays_, targets_ ? config_.targets.size() : 0);
  describe();
}

void ChannelSensor::find_near_links() {
  Spending pairs(budget::element_pairs);
  for (size_t r = 0; r < receiver_arrays_.size(); ++r)
    for (size_t t = 0; t < transmitter_arrays_.size(); ++t) {
      // An array that hears itself is at no distance of itself; its waves come back from far away.
      if (config_.transmitters[t] == config_.receivers[r]) continue;
      const double within_m =
          every_element_within_m(experiment_.scenario, config_, transmitter_arrays_[t], receiver_arrays_[r]);
      const bool all = std::isinf(within_m);
      if (!(within_m > 0.0 && (all || may_be_near(experiment_.scenario, config_, t, r)))) continue;
      const uint64_t of_link =
          uint64_t{transmitter_arrays_[t].element_count()} * receiver_arrays_[r].element_count();
      pairs.plan(fmt::format("channel '{}': {} and {}, {} elements and {}, may be in their near field "
                             "(effects: {{every_element: off}} takes one path for all elements)",
                             config_.name, config_.transmitters[t], config_.receivers[r],
                             transmitter_arrays_[t].element_count(), receiver_arrays_[r].element_count()),
                 of_link);
      near_links_.push_back({r, t, within_m, nullptr, {}});
    }
}

std::unique_ptr<ElementPaths> ChannelSensor::make_elements(const NearLink& link) const {
  const ChannelPaths& paths = *paths_[link.transmitter];
  return std::make_unique<ElementPaths>(
      gpu_scene_, crossings_, experiment_, radio_, channel_,
      ArrayEnd{paths.transmitter(), transmitter_arrays_[link.transmitter]},
      ArrayEnd{paths.receivers()[link.receiver], receiver_arrays_[link.receiver]});
}

void ChannelSensor::start(const TickContext& context) {
  for (const auto& paths : paths_) paths->start(context);
  if (targets_) targets_->start(context);
  for (const NearLink& link : near_links_)
    if (link.elements) link.elements->start();
}

void ChannelSensor::record(gpu::TickSlot& slot, const TickContext& context) {
  moments_[slot.index] = {context.sequence, context.tick};
  for (const auto& paths : paths_) paths->record(slot, context);
  if (targets_) targets_->record(slot, context);
  for (NearLink& link : near_links_) {
    const ChannelPaths& paths = *paths_[link.transmitter];
    const double distance_m = glm::distance(world_position(paths.transmitter(), context),
                                            world_position(paths.receivers()[link.receiver], context));
    link.recorded[slot.index] = distance_m < link.within_m;
    if (!link.recorded[slot.index]) continue;
    if (!told_near_)
      spdlog::info(
          "channel '{}', tick {}: {} and {} are in the near field: every element is searched from, once "
          "(effects: {{every_element: off}} to do without)",
          config_.name, context.tick, paths.transmitter().name, paths.receivers()[link.receiver].name);
    told_near_ = true;
    if (!link.elements) link.elements = make_elements(link);
    link.elements->record(slot, context);
  }
}

bool ChannelSensor::looks_ahead() const {
  return (targets_ && targets_->looks_ahead()) ||
         std::any_of(paths_.begin(), paths_.end(), [](const auto& paths) { return paths->looks_ahead(); });
}

void ChannelSensor::record_ahead(gpu::TickSlot& slot, const TickContext& next) {
  for (const auto& paths : paths_) paths->record_ahead(slot, next);
  if (targets_) targets_->record_ahead(slot, next);
}

std::vector<Array> ChannelSensor::collect(const gpu::TickSlot& slot) {
  Results results;
  for (const auto& paths : paths_) results.push_back(paths->collect(slot));
  if (targets_) {
    targets_->collect(slot);
    for (uint32_t t = 0; t < results.size(); ++t)
      for (size_t r = 0; r < results[t].links.size(); ++r)
        targets_->add_echoes(t, r, results[t].links[r].paths);
  }
  for (NearLink& link : near_links_)
    if (link.recorded[slot.index]) {
      link.elements->collect(slot);
      left_out_of_elements_.add(link.elements->left_out());
      ++near_ticks_;
    }
  check_sights(results);
  return arrays_of(results, slot.index);
}

const ElementPaths* ChannelSensor::elements_of(size_t receiver, size_t transmitter, uint32_t slot) const {
  for (const NearLink& link : near_links_)
    if (link.receiver == receiver && link.transmitter == transmitter)
      return link.recorded[slot] ? link.elements.get() : nullptr;
  return nullptr;
}

void ChannelSensor::check_sights(const Results& results) {
  sights_ = {};
  for (const ChannelPaths::Result& result : results)
    for (const ChannelPaths::Link& link : result.links)
      for (const rf::Path& path : link.paths)
        if (path.interactions.empty())
          sights_.add(std::abs(speed_of_light * path.delay_s - link.distance_m) / link.distance_m);
}

Evidence ChannelSensor::evidence() const {
  Evidence evidence;
  evidence.delays_against_distances = &sights_;
  evidence.sensed = sensing_ && sensing_->detects() && targets_;
  return evidence;
}

void ChannelSensor::count(std::map<std::string, uint64_t>& counters) const {
  for (const auto& paths : paths_) {
    std::map<std::string, uint64_t> own;
    paths->count(own);
    for (const auto& [name, value] : own) counters[config_.name + "." + name] += value;
  }
  if (targets_) {
    std::map<std::string, uint64_t> of_targets;
    targets_->count(of_targets);
    for (const auto& [name, value] : of_targets) counters[config_.name + "." + name] = value;
  }
  if (sensing_) {
    std::map<std::string, uint64_t> of_sensing;
    sensing_->count(of_sensing);
    for (const auto& [name, value] : of_sensing) counters[config_.name + "." + name] = value;
  }
  if (near_links_.empty()) return;
  std::map<std::string, uint64_t> of_elements;
  for (const NearLink& link : near_links_)
    if (link.elements) link.elements->count(of_elements);
  counters[config_.name + ".every_element_links"] = near_ticks_;
  for (const char* name : {"paths", "candidate_overflow", "path_overflow"})
    counters[fmt::format("{}.every_element_{}", config_.name, name)] = of_elements[name];
}

void ChannelSensor::warn(std::vector<std::string>& warnings) const {
  if (sensing_) sensing_->warn(warnings);
}

void ChannelSensor::note(std::vector<std::pair<std::string, std::string>>& notes) const {
  LinkLeftOut left_out = left_out_of_elements_;
  for (const auto& paths : paths_) left_out.add(paths->left_out());
  if (targets_) left_out.add(targets_->left_out());
  for (const auto& [name, text] : paths_[0]->notes(left_out))
    notes.emplace_back(config_.name + "." + name, text);
}

}  // namespace greatx::sim
