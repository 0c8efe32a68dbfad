// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Computes all paths of one channel at one tick, outside a run: between its own ends, or to any points.
// `greatx paths`, radio maps and Python are built on it.
#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "gpu/tick_ring.h"
#include "rf/paths/crossings.h"
#include "scene/device/gpu_scene.h"
#include "sim/channel/channel_paths.h"
#include "sim/channel/channel_targets.h"
#include "sim/world/moment.h"

namespace greatx::sim {

/// A channel at one moment on a device, with everything that solving its links needs.
class ChannelSnapshot {
 public:
  struct Instant {
    uint32_t sequence = 0;
    int64_t tick = 0;
    std::optional<uint32_t> transmitter;  ///< only this one; none: all
  };
  /// Describes a link between one transmitter and one receiver. Positions and orientations are in local
  /// coordinates (world - Scene::origin).
  struct Link {
    uint32_t transmitter = 0;  ///< index in the channel
    size_t receiver = 0;       ///< index in the channel, or in the list of points
    std::string transmitter_name, receiver_name;
    rf::EndState transmitter_state, receiver_state;
    double distance_m = 0.0;
    LinkLeftOut left_out;
    std::vector<rf::Path> paths;  ///< canonical order (rf::interactions_less)
    /// The facets for which the paths were solved. They never move.
    std::shared_ptr<const rf::FacetWorld> world;
  };
  /// `device` and `experiment` outlive this. `options` are those of the scene on the GPU, for a caller that
  /// also draws it; none: the options of the plan. Throws UserError like ChannelPaths.
  ChannelSnapshot(gpu::Device& device, const Experiment& experiment, uint32_t channel, const Instant& instant,
                  const std::optional<scene::GpuSceneOptions>& options = {});

  /// Moves to another moment with the same transmitters. The parts that stand still are neither uploaded nor
  /// searched again. The paths are the same as those of a snapshot made at that moment. The counters
  /// continue.
  void move(uint32_t sequence, int64_t tick);

  /// Takes one link. Links come receiver by receiver in their order, each with all transmitters in theirs.
  /// Returns false to stop.
  using Take = std::function<bool(Link)>;
  /// Solves the links to the receivers of the channel.
  void solve(const Take& take);
  /// Solves the links to points at rest in the world instead, without echoes of targets. `points_at_once` of
  /// them are in memory at a time; the results do not depend on this number. `first` is the number of the
  /// first point in its list. With `check`, points inside a solid are counted and reported.
  void solve(std::span<const dvec3> points, size_t first, const Take& take, bool check = true);
  static constexpr size_t points_at_once = 256;

  const Experiment& experiment() const { return experiment_; }
  uint32_t channel() const { return channel_; }
  const Moment& moment() const { return moment_; }
  const rf::RadioModel& model() const { return radio_->model(); }
  /// Returns the model as a shared pointer, for results that outlive the snapshot.
  std::shared_ptr<const RadioWorld> radio() const { return radio_; }
  size_t transmitters() const { return paths_.size(); }
  /// Adds the counts of all transmitters.
  void count(std::map<std::string, uint64_t>& counters) const;
  /// Returns (name, text) pairs that say how candidates are found, and which guarantee holds for links with
  /// these omissions.
  std::vector<std::pair<std::string, std::string>> notes(const LinkLeftOut& left_out) const {
    return paths_[0]->notes(left_out);
  }
  /// Returns the notes for all links so far.
  std::vector<std::pair<std::string, std::string>> notes() const;
  scene::GpuScene& gpu_scene() { return gpu_scene_; }
  gpu::TickRing& ring() { return ring_; }

 private:
  bool solve_batch(size_t first, const Take& take, bool echoes);

  const Experiment& experiment_;
  uint32_t channel_;
  scene::GpuScene gpu_scene_;
  gpu::TickRing ring_;
  Courses courses_;
  Moment moment_;
  rf::CrossingPass crossings_;
  std::shared_ptr<RadioWorld> radio_;
  std::vector<uint32_t> transmitters_;                ///< indices in the channel
  std::vector<std::unique_ptr<ChannelPaths>> paths_;  ///< [transmitters_]
  std::unique_ptr<ChannelTargets> targets_;           ///< null: no echoes of targets
  bool started_ = false, targets_started_ = false;
};

}  // namespace greatx::sim
