// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "sim/sensors/registry/radio_ahead.h"

#include <algorithm>

#include "core/beside.h"
#include "core/parallel.h"
#include "rf/field/finite_reflectors.h"
#include "sim/sensors/radar/radar_sensor.h"

namespace greatx::sim {

namespace {

/// Calls visit(place, configuration) for the radars of a scenario.
template <typename Visit>
void over_radars(const Scenario& scenario, const Visit& visit) {
  for (uint32_t node = 0; node < scenario.nodes.size(); ++node)
    for (uint32_t i = 0; i < scenario.nodes[node].sensors.size(); ++i)
      if (const auto* radar = std::get_if<RadarConfig>(&scenario.nodes[node].sensors[i].config))
        visit(SensorPlace{node, i}, *radar);
}

}  // namespace

RadioAhead::RadioAhead(const gpu::Device& device, const Experiment& experiment)
    : experiment_(experiment), gpu_scene_(uploaded_.get_future()) {
  const Scenario& scenario = experiment.scenario;
  const EffectPlan& plan = experiment.plan;
  size_t users = plan.finite_reflectors.on || plan.diffraction.on ? scenario.channels.size() : 0;
  over_radars(scenario, [&](SensorPlace at, const RadarConfig& config) {
    if (!rf::EchoFinder::traces_on_host(device, config.echoes)) return;
    users += plan.radar_edges.on ? 1 : 0;
    radars_.push_back({at, Task<std::unique_ptr<Sensor>>([this, at] {
                         return std::make_unique<RadarSensor>(*gpu_scene_.get(), experiment_, at.node,
                                                              at.sensor, survey());
                       })});
  });
  for (uint32_t channel = 0; channel < scenario.channels.size(); ++channel)
    worlds_.emplace_back(
        [this, channel] { return std::make_shared<RadioWorld>(experiment_, channel, survey()); });
  surveys_ = users > 1;
  if (usable_cores() > 1 && !(radars_.empty() && worlds_.empty())) thread_ = start_beside([this] { run(); });
}

scene::GpuScene& RadioAhead::begin_radars(scene::GpuScene& gpu_scene) {
  begun_ = true;
  uploaded_.set_value(&gpu_scene);
  return gpu_scene;
}

RadioAhead::~RadioAhead() {
  stop_ = true;
  if (!begun_) uploaded_.set_value(nullptr);
  if (thread_.joinable()) thread_.join();
}

void RadioAhead::run() {
  for (auto& task : worlds_)
    if (!stop_) task.make();
  if (radars_.empty() || gpu_scene_.get() == nullptr) return;
  for (Radar& radar : radars_)
    if (!stop_) radar.task.make();
}

const scene::EdgeSurvey* RadioAhead::survey() {
  if (!surveys_) return nullptr;
  std::call_once(surveyed_, [&] {
    // The channels' reflectors take the most edges.
    survey_ =
        std::make_unique<const scene::EdgeSurvey>(experiment_.scene(), rf::FiniteReflectors::edge_options());
  });
  return survey_.get();
}

template <typename Made>
Made RadioAhead::take(Task<Made>& task) {
  if (!thread_.joinable()) task.make();
  return wait_watched(task.made);
}

std::unique_ptr<Sensor> RadioAhead::radar(SensorPlace at) {
  const auto found = std::ranges::find_if(
      radars_, [&](const Radar& radar) { return radar.at.node == at.node && radar.at.sensor == at.sensor; });
  return found == radars_.end() ? nullptr : take(found->task);
}

std::shared_ptr<RadioWorld> RadioAhead::world(uint32_t channel) { return take(worlds_[channel]); }

}  // namespace greatx::sim
