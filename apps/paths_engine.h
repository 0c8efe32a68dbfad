// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <memory>
#include <span>
#include <vector>

#include "apps/paths_facts.h"
#include "gpu/tick_ring.h"
#include "rf/crossings.h"
#include "scene/gpu_scene.h"
#include "sim/channel_paths.h"
#include "sim/moment.h"

namespace greatx::apps {

/// All paths of one channel at one tick, outside a run.
class PathsEngine {
 public:
  struct Instant {
    uint32_t sequence = 0;
    int64_t tick = 0;
  };
  /// All arguments but `options` outlive the engine.
  PathsEngine(gpu::Device& device, const sim::Scenario& scenario, const sim::World& world,
              const sim::EffectPlan& plan, const scene::GpuSceneOptions& options, uint32_t channel,
              const Instant& instant);

  /// Receivers one after the other in their order; false: enough.
  using Take = std::function<bool(PathLink)>;
  /// The channel's own receivers.
  void solve(const Take& take);
  /// Points at rest in the world instead, `points_at_once` in the memory at a time; nothing depends on the number.
  /// `first`: the index of the first of them in its list.
  void solve(std::span<const dvec3> points, size_t first, const Take& take);
  static constexpr size_t points_at_once = 256;

  const sim::Moment& moment() const { return moment_; }
  const sim::ChannelPaths& channel() const { return *channel_; }
  /// For names and coordinates; valid as long as the engine.
  PathScene scene() const;
  scene::GpuScene& gpu_scene() { return gpu_scene_; }
  gpu::TickRing& ring() { return ring_; }

 private:
  bool solve_batch(size_t first, const Take& take);

  const sim::ChannelConfig& config_;
  const sim::World& world_;
  scene::GpuScene gpu_scene_;
  gpu::TickRing ring_;
  std::vector<std::unique_ptr<sim::Path>> trajectories_;
  sim::Moment moment_;
  rf::CrossingPass crossings_;
  std::unique_ptr<sim::ChannelPaths> channel_;
  bool started_ = false;
};

}  // namespace greatx::apps
