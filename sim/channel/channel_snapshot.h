// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// All paths of one channel at one tick, outside a run: between its own ends, or to any points. `greatx
// paths`, radio maps and Python are built on it.
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
#include "sim/world/moment.h"

namespace greatx::sim {

class ChannelSnapshot {
 public:
  struct Instant {
    uint32_t sequence = 0;
    int64_t tick = 0;
    std::optional<uint32_t> transmitter;  ///< this one alone; none: all
  };
  /// One transmitter and one receiver; positions and orientations in local coordinates (world -
  /// Scene::origin).
  struct Link {
    uint32_t transmitter = 0;  ///< index in the channel
    size_t receiver = 0;       ///< index in the channel, or in the list of points
    std::string transmitter_name, receiver_name;
    rf::EndState transmitter_state, receiver_state;
    double distance_m = 0.0;
    LinkLeftOut left_out;
    std::vector<rf::Path> paths;  ///< canonical order (rf::interactions_less)
    /// The facets that the paths were solved among, which never move.
    std::shared_ptr<const rf::FacetWorld> world;
  };
  /// `device` and `experiment` outlive this. `options`: of the scene on the GPU, for whoever draws it as
  /// well; none: the plan's. Throws UserError like ChannelPaths.
  ChannelSnapshot(gpu::Device& device, const Experiment& experiment, uint32_t channel, const Instant& instant,
                  const std::optional<scene::GpuSceneOptions>& options = {});

  /// To another moment, with the same transmitters: what stands still is neither uploaded nor searched again.
  /// Gives the same paths as a snapshot that is made there; counters go on.
  void move(uint32_t sequence, int64_t tick);

  /// Receivers one after the other in their order, each with all transmitters in theirs; false: enough.
  using Take = std::function<bool(Link)>;
  /// The channel's own receivers.
  void solve(const Take& take);
  /// Points at rest in the world instead, `points_at_once` in the memory at a time; nothing depends on the
  /// number. `first`: the number of the first of them in its list. `check`: points that stand inside
  /// something are counted and said.
  void solve(std::span<const dvec3> points, size_t first, const Take& take, bool check = true);
  static constexpr size_t points_at_once = 256;

  const Experiment& experiment() const { return experiment_; }
  uint32_t channel() const { return channel_; }
  const Moment& moment() const { return moment_; }
  const rf::RadioModel& model() const { return radio_->model(); }
  /// The same for those whose results outlive the snapshot.
  std::shared_ptr<const RadioWorld> radio() const { return radio_; }
  size_t transmitters() const { return paths_.size(); }
  /// Summed over the transmitters.
  void count(std::map<std::string, uint64_t>& counters) const;
  /// How candidates are found and what that guarantees of links that `left_out` is of: (name, text).
  std::vector<std::pair<std::string, std::string>> notes(const LinkLeftOut& left_out) const {
    return paths_[0]->notes(left_out);
  }
  /// The same of all links so far.
  std::vector<std::pair<std::string, std::string>> notes() const;
  scene::GpuScene& gpu_scene() { return gpu_scene_; }
  gpu::TickRing& ring() { return ring_; }

 private:
  bool solve_batch(size_t first, const Take& take);

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
  bool started_ = false;
};

}  // namespace greatx::sim
