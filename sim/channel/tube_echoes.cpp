// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "sim/channel/tube_echoes.h"

#include <algorithm>

#include "core/units.h"
#include "sim/plan/radar_plan.h"

namespace greatx::sim {

namespace {

/// Time over which the rate of a delay is taken if the record has one time sample.
constexpr double rate_time_s = 1e-4;

rf::TubeOptions options_of(const Experiment& experiment, const ChannelConfig& config,
                           const std::vector<TubeTarget>& targets, const TargetTubes& tubes) {
  rf::TubeOptions options;
  for (const TubeTarget& target : targets) options.instances.push_back(target.instance);
  options.tube_m = tubes.tube_m;
  options.budget = tubes.budget;
  options.max_bounces = tubes.max_bounces;
  const EffectPlan& plan = experiment.plan;
  options.roughness = plan.roughness.on;
  if (plan.gas.on || plan.rain.on || plan.fog.on)
    options.air_db_per_km = radar_air_db_per_km(experiment.scenario.environment, config.carrier_hz);
  options.seed = experiment.scenario.seed;
  options.bandwidth_hz = std::max(1.0, config.subcarriers * config.subcarrier_spacing_hz);
  return options;
}

}  // namespace

TubeEchoes::TubeEchoes(scene::GpuScene& gpu_scene, const Experiment& experiment, const ChannelConfig& config,
                       const rf::RadioSurfaces& surfaces, const rf::ChannelGrid& grid,
                       std::vector<TubeTarget> targets, const TargetTubes& options)
    : experiment_(experiment), config_(config), targets_(std::move(targets)) {
  for (uint32_t m = 0; m < grid.time_samples; ++m) times_s_.push_back(m * grid.time_spacing_s);
  const rf::TubeOptions tubes = options_of(experiment, config, targets_, options);
  for (const std::string& receiver : config.receivers)
    for (const std::string& transmitter : config.transmitters) {
      Link& link = links_.emplace_back();
      link.transmitter = antenna_end(experiment, transmitter);
      link.receiver = antenna_end(experiment, receiver);
      link.finder = std::make_unique<rf::TubeTargets>(gpu_scene, surfaces, config.name, link.transmitter.body,
                                                      link.receiver.body, tubes);
    }
}

rf::EchoMotion TubeEchoes::motion_of(const Link& link, const TickContext& context) const {
  rf::EchoMotion motion;
  const auto end = [&](const ChannelEnd& of) {
    return [&world = *experiment_.world, at = context.motion_at, start_s = context.time_s,
            node = of.node.value(), mount = of.mount](double time_s) {
      Pose pose = world.scene.to_local(at(node, start_s + time_s).pose) * mount;
      pose.orientation = dquat(1.0, 0.0, 0.0, 0.0);  // the elements have the axes of the world
      return pose;
    };
  };
  motion.transmitter = end(link.transmitter);
  motion.receiver = end(link.receiver);
  motion.body = [at = context.body_motion_at, start_s = context.time_s](uint32_t body, double time_s) {
    return at(body, start_s + time_s).pose;
  };
  const bool burst = times_s_.size() > 1 && times_s_[1] > 0.0;
  motion.slot_start_s = burst ? times_s_ : std::vector<double>{0.0};
  motion.slot_s = burst ? times_s_[1] : rate_time_s;
  return motion;
}

void TubeEchoes::record(gpu::TickSlot& slot, const TickContext& context) {
  for (Link& link : links_) {
    InFlight& flight = link.in_flight[slot.index];
    flight.motion = motion_of(link, context);
    flight.transmitter = flight.motion.transmitter(0.0).position;
    flight.receiver = flight.motion.receiver(0.0).position;
    flight.rays = link.finder->record(slot, flight.transmitter, flight.receiver, context.body_poses);
  }
}

void TubeEchoes::collect(const gpu::TickSlot& slot) {
  for (Link& link : links_) link.echoes = paths_of(link, link.in_flight[slot.index]);
}

std::vector<rf::Path> TubeEchoes::paths_of(const Link& link, const InFlight& flight) const {
  const scene::Scene& scene = experiment_.scene();
  const double carrier_hz = config_.carrier_hz;
  std::vector<rf::Path> paths;
  std::map<uint32_t, uint32_t> counts;
  for (const rf::TubeEcho& echo : link.finder->collect(flight.rays, flight.motion, times_s_)) {
    const uint32_t body = scene.owner_of(scene.instances[echo.instance].body);
    const auto target = std::ranges::find_if(targets_, [&](const TubeTarget& t) {
      return scene.owner_of(scene.instances[t.instance].body) == body;
    });
    if (target == targets_.end() || target->node == link.transmitter.node ||
        target->node == link.receiver.node)
      continue;
    rf::Path& path = paths.emplace_back();
    path.interactions.push_back({rf::InteractionType::target, target->instance, counts[target->instance]++});
    path.vertices = {flight.transmitter, echo.point, flight.receiver};
    path.delay_s = echo.delay_s.front();
    path.length_m = path.delay_s * speed_of_light;
    path.doppler_hz = -carrier_hz * echo.rate;
    path.departure = echo.departure;
    path.arrival = echo.arrival;
    path.transfer[2 * echo.received + echo.sent] = echo.transfer;
    auto own = std::make_shared<rf::TargetEcho>();
    for (const double delay_s : echo.delay_s) own->turns.push_back(-carrier_hz * (delay_s - path.delay_s));
    path.echo = std::move(own);
  }
  return paths;
}

void TubeEchoes::add_echoes(size_t transmitter, size_t receiver, std::vector<rf::Path>& paths) const {
  const std::vector<rf::Path>& own = links_[receiver * config_.transmitters.size() + transmitter].echoes;
  paths.insert(paths.end(), own.begin(), own.end());
}

}  // namespace greatx::sim
