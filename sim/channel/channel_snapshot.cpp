// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "sim/channel/channel_snapshot.h"

#include <algorithm>

#include "sim/channel/blocks.h"
#include "sim/plan/plan_options.h"

namespace greatx::sim {

namespace {

constexpr VkDeviceSize first_upload_bytes = 4u << 20, first_readback_bytes = 16u << 20;

}  // namespace

ChannelSnapshot::ChannelSnapshot(gpu::Device& device, const Experiment& experiment, uint32_t channel,
                                 const Instant& instant, const std::optional<scene::GpuSceneOptions>& options)
    : experiment_(experiment),
      channel_(channel),
      gpu_scene_(device, experiment.scene(), options.value_or(gpu_scene_options(experiment.plan))),
      ring_(device, slots_in_flight, first_upload_bytes, first_readback_bytes),
      courses_(make_courses(experiment.scenario, *experiment.world, instant.sequence)),
      moment_(moment_at(*experiment.world, courses_, Clock(experiment.scenario.tick_rate_hz), instant.tick)),
      crossings_(gpu_scene_, rf::facet_kinds(experiment.scene(), radio_effects(experiment))),
      radio_(std::make_shared<RadioWorld>(experiment, channel)) {
  for (uint32_t t = 0; t < experiment.scenario.channels[channel].transmitters.size(); ++t)
    if (t == instant.transmitter.value_or(t)) transmitters_.push_back(t);
  GREATX_CHECK(!transmitters_.empty(), "no transmitter {}", *instant.transmitter);
  for (const uint32_t t : transmitters_) {
    ChannelEnds ends = channel_ends(experiment, channel, t);
    ends.check_receivers = t == transmitters_[0];
    paths_.push_back(
        std::make_unique<ChannelPaths>(gpu_scene_, crossings_, experiment, radio_, channel, std::move(ends)));
  }
  if (experiment.plan.target_echoes.on && !experiment.scenario.channels[channel].targets.empty())
    targets_ = std::make_unique<ChannelTargets>(
        gpu_scene_, crossings_, experiment, radio_, channel,
        channel_grid(experiment.scenario.channels[channel], experiment.plan));
}

void ChannelSnapshot::move(uint32_t sequence, int64_t tick) {
  courses_ = make_courses(experiment_.scenario, *experiment_.world, sequence);
  moment_ = moment_at(*experiment_.world, courses_, Clock(experiment_.scenario.tick_rate_hz), tick);
  started_ = targets_started_ = false;  // the moment is treated as the start of a sequence
}

void ChannelSnapshot::solve(const Take& take) { solve_batch(0, take, targets_ != nullptr); }

void ChannelSnapshot::solve(std::span<const dvec3> points, size_t first, const Take& take, bool check) {
  paths_[0]->check_receivers(check);  // one check is enough for points with several transmitters
  for (size_t begin = 0; begin < points.size(); begin += points_at_once) {
    for (const auto& paths : paths_)
      paths->set_points(points.subspan(begin, std::min(points_at_once, points.size() - begin)),
                        first + begin);
    if (!solve_batch(first + begin, take, false)) return;
  }
}

bool ChannelSnapshot::solve_batch(size_t first, const Take& take, bool echoes) {
  if (!started_)
    for (const auto& paths : paths_) paths->start(moment_.context);
  started_ = true;
  if (echoes && !targets_started_) targets_->start(moment_.context);
  targets_started_ |= echoes;
  gpu::TickSlot& slot = ring_.begin();
  gpu_scene_.record_update(slot, moment_.bodies);
  for (const auto& paths : paths_) paths->record(slot, moment_.context);
  if (echoes) targets_->record(slot, moment_.context);
  ring_.submit(slot);
  ring_.wait(slot);
  std::vector<ChannelPaths::Result> results;
  for (const auto& paths : paths_) results.push_back(paths->collect(slot));
  if (echoes) targets_->collect(slot);

  for (size_t r = 0; r < results[0].links.size(); ++r)
    for (size_t t = 0; t < results.size(); ++t) {
      ChannelPaths::Link& solved = results[t].links[r];
      if (echoes) targets_->add_echoes(transmitters_[t], r, solved.paths);
      Link link{transmitters_[t],
                first + r,
                paths_[t]->transmitter().name,
                paths_[t]->receivers()[r].name,
                results[t].transmitter,
                solved.receiver,
                solved.distance_m,
                solved.left_out,
                std::move(solved.paths),
                results[t].world};
      if (!take(std::move(link))) return false;
    }
  return true;
}

std::vector<std::pair<std::string, std::string>> ChannelSnapshot::notes() const {
  LinkLeftOut all;
  for (const auto& paths : paths_) all.add(paths->left_out());
  return notes(all);
}

void ChannelSnapshot::count(std::map<std::string, uint64_t>& counters) const {
  for (const auto& paths : paths_) {
    std::map<std::string, uint64_t> own;
    paths->count(own);
    for (const auto& [name, value] : own) counters[name] += value;
  }
}

}  // namespace greatx::sim
