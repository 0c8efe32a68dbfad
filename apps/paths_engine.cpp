// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "apps/paths_engine.h"

#include <algorithm>

namespace greatx::apps {

namespace {

constexpr VkDeviceSize first_upload_bytes = 4u << 20, first_readback_bytes = 16u << 20;

}  // namespace

PathsEngine::PathsEngine(gpu::Device& device, const sim::Scenario& scenario, const sim::World& world,
                         const sim::EffectPlan& plan, const scene::GpuSceneOptions& options, uint32_t channel,
                         const Instant& instant)
    : config_(scenario.channels[channel]),
      world_(world),
      gpu_scene_(device, world.scene, options),
      ring_(device, sim::slots_in_flight, first_upload_bytes, first_readback_bytes),
      trajectories_(sim::make_paths(scenario, instant.sequence)),
      moment_(sim::moment_at(world, trajectories_, sim::Clock(scenario.tick_rate_hz), instant.tick)),
      crossings_(gpu_scene_, rf::facet_kinds(world.scene, sim::radio_effects(plan, scenario))),
      channel_(std::make_unique<sim::ChannelPaths>(gpu_scene_, crossings_, plan, scenario, world, channel)) {}

PathScene PathsEngine::scene() const { return {&world_.scene, channel_->model().wedges, config_.carrier_hz}; }

void PathsEngine::solve(const Take& take) { solve_batch(0, take); }

void PathsEngine::solve(std::span<const dvec3> points, size_t first, const Take& take) {
  for (size_t begin = 0; begin < points.size(); begin += points_at_once) {
    channel_->set_points(points.subspan(begin, std::min(points_at_once, points.size() - begin)),
                         first + begin);
    if (!solve_batch(first + begin, take)) return;
  }
}

bool PathsEngine::solve_batch(size_t first, const Take& take) {
  if (!started_) channel_->start(moment_.context);
  started_ = true;
  gpu::TickSlot& slot = ring_.begin();
  gpu_scene_.record_update(slot, moment_.bodies);
  channel_->record(slot, moment_.context);
  ring_.submit(slot);
  ring_.wait(slot);
  sim::ChannelPaths::Result result = channel_->collect(slot);

  const dvec3 origin = world_.scene.origin;
  for (size_t i = 0; i < result.links.size(); ++i) {
    sim::ChannelPaths::Link& solved = result.links[i];
    const sim::ChannelEnd& end = channel_->receivers()[i];
    PathLink link;
    link.index = static_cast<uint32_t>(first + i);
    link.name = end.name;
    link.transmitter_m = result.transmitter.position + origin;
    link.receiver_m = solved.receiver.position + origin;
    link.distance_m = solved.distance_m;
    link.paths = std::move(solved.paths);
    sort_by_delay(link.paths);
    if (!take(std::move(link))) return false;
  }
  return true;
}

}  // namespace greatx::apps
