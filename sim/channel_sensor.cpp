// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "sim/channel_sensor.h"

#include <cmath>

#include "core/units.h"
#include "sim/channel_antennas.h"

namespace greatx::sim {

ChannelSensor::ChannelSensor(scene::GpuScene& gpu_scene, rf::CrossingPass& crossings, const EffectPlan& plan,
                             const Scenario& scenario, const World& world, uint32_t channel)
    : world_(world),
      config_(scenario.channels[channel]),
      doppler_(plan.doppler.on),
      paths_(gpu_scene, crossings, plan, scenario, world, channel),
      transmitter_array_(antenna_array(scenario, config_.transmitter, config_.carrier_hz)) {
  for (const std::string& name : config_.receivers)
    receiver_arrays_.push_back(antenna_array(scenario, name, config_.carrier_hz));
  for (const rf::AntennaArray& receiver : receiver_arrays_)
    if (receiver.port_count() != receiver_arrays_[0].port_count())
      throw_user_error_at(config_.where,
                          "channel '{}': rx: expected receivers with one number of ports, found {} and {}; "
                          "give each its own channel",
                          config_.name, receiver_arrays_[0].port_count(), receiver.port_count());
  grid_ = {config_.carrier_hz, config_.subcarrier_spacing_hz, config_.subcarriers, config_.time_samples,
           doppler_ ? config_.time_spacing_s : 0.0};
  if (plan.dispersion.on)
    dispersion_.emplace(world.scene, paths_.model().field_model(), paths_.model().effects.weather, grid_);
  describe();
}

std::vector<Array> ChannelSensor::collect(const gpu::TickSlot& slot) {
  const ChannelPaths::Result result = paths_.collect(slot);
  for (const ChannelPaths::Link& link : result.links)
    for (const rf::Path& path : link.paths)
      if (path.interactions.empty())
        line_of_sight_errors_.add(std::abs(speed_of_light * path.delay_s - link.distance_m) /
                                  link.distance_m);
  return arrays_of(result);
}

void ChannelSensor::count(std::map<std::string, uint64_t>& counters) const {
  std::map<std::string, uint64_t> own;
  paths_.count(own);
  for (const auto& [name, value] : own) counters[config_.name + "." + name] = value;
}

void ChannelSensor::note(std::vector<std::pair<std::string, std::string>>& notes) const {
  for (const auto& [name, text] : paths_.notes()) notes.emplace_back(config_.name + "." + name, text);
}

}  // namespace greatx::sim
