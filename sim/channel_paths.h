// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// The paths of one channel at a tick: from the poses of its ends to fields, without antennas and files. The channel
// sensor and `greatx paths` are built on it.
#pragma once

#include <array>
#include <memory>
#include <optional>
#include <vector>

#include "rf/path_solver.h"
#include "sim/effect_plan.h"
#include "sim/sensor.h"
#include "sim/world.h"

namespace greatx::sim {

/// The radio effects of a plan, for rf/.
rf::RadioEffects radio_effects(const EffectPlan& plan, const Scenario& scenario);

/// One end of a channel: an antenna on a node, or a bare point.
struct ChannelEnd {
  std::string name;              ///< "node/sensor", or "receiver 17"
  std::optional<uint32_t> node;  ///< none: a point at rest
  Pose mount;                    ///< on its node; without a node: in the world
  uint32_t body = 0;             ///< that carries the node and does not hide it; 0: none
};

class ChannelPaths {
 public:
  /// What one link had at a tick.
  struct Link {
    rf::EndState receiver;
    double distance_m = 0.0;
    std::vector<rf::Path> paths;  ///< canonical order (rf::interactions_less)
  };
  struct Result {
    rf::EndState transmitter;
    std::vector<Link> links;  ///< [receivers]
  };

  /// `crossings` is shared by all channels. `points`: world positions of receivers that stand in for the channel's own
  /// (at rest, isotropic); empty: the channel's. Throws UserError if `search: once` is asked for and no end of the channel
  /// stands still.
  ChannelPaths(scene::GpuScene& gpu_scene, rf::CrossingPass& crossings, const EffectPlan& plan,
               const Scenario& scenario, const World& world, uint32_t channel,
               std::span<const dvec3> points = {});

  /// Before the first tick of a sequence: candidates from a static end (from the cache if it has them).
  void start(const TickContext& context);
  bool looks_ahead() const;
  void record_ahead(gpu::TickSlot& slot, const TickContext& next);
  void record(gpu::TickSlot& slot, const TickContext& context);
  Result collect(const gpu::TickSlot& slot);

  const ChannelEnd& transmitter() const { return transmitter_; }
  const std::vector<ChannelEnd>& receivers() const { return receivers_; }
  const rf::RadioModel& model() const { return model_; }
  /// Candidates, overflows, paths; named without the channel.
  void count(std::map<std::string, uint64_t>& counters) const;
  /// How candidates are found and what that guarantees, one line each.
  std::vector<std::pair<std::string, std::string>> notes() const;

 private:
  // (lead)
  ChannelEnd transmitter_;
  std::vector<ChannelEnd> receivers_;
  rf::RadioModel model_;
};

}  // namespace greatx::sim
