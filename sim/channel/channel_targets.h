// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Computes the echoes of a channel's targets, which are points at the centres of their bodies
// (docs/targets.md). Every antenna of the channel has a ChannelPaths whose receivers are the targets: its
// legs. An echo joins a leg of the transmitter and a reversed leg of the receiver; an antenna that hears
// itself has one set of legs for both.
#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "rf/targets/target_model.h"
#include "sim/channel/channel_paths.h"
#include "sim/channel/tube_echoes.h"

namespace greatx::sim {

/// Describes where a target is at a tick.
struct TargetState {
  uint32_t instance = 0;  ///< index into Scene::instances
  uint32_t node = 0;
  rf::EndState centre;  ///< the pose of its frame and its velocity, at the centre of its bounds
  std::shared_ptr<const rf::TargetModel> surface;  ///< a panel with its phases of the tick; null: none
};

/// Returns the instance of a target: the first one of its body. Throws UserError if the node has no surfaces.
uint32_t target_instance(const Experiment& experiment, const TargetConfig& target);

class ChannelTargets {
 public:
  /// The channel has targets. All arguments outlive this.
  ChannelTargets(scene::GpuScene& gpu_scene, rf::CrossingPass& crossings, const Experiment& experiment,
                 const std::shared_ptr<RadioWorld>& radio, uint32_t channel, const rf::ChannelGrid& grid);

  void start(const TickContext& context);
  bool looks_ahead() const;
  void record_ahead(gpu::TickSlot& slot, const TickContext& next);
  void record(gpu::TickSlot& slot, const TickContext& context);
  /// Solves the legs of the tick of `slot`. The calls below refer to it.
  void collect(const gpu::TickSlot& slot);

  /// Replaces the paths of a link that the surfaces of a target reflect, scatter or diffract by the echoes of
  /// the targets. `paths` stay in canonical order. An antenna that a target carries gets no echo of it.
  void add_echoes(uint32_t transmitter, size_t receiver, std::vector<rf::Path>& paths);

  const std::vector<TargetState>& states() const { return states_; }
  /// Adds the counts of legs and echoes.
  void count(std::map<std::string, uint64_t>& counters) const;
  /// Returns the omissions of all legs so far.
  LinkLeftOut left_out() const;

 private:
  struct Target {
    ChannelEnd centre;
    uint32_t instance = 0;
    std::unique_ptr<const rf::TargetModel> own;  ///< null: `model` belongs to the scenario
    const rf::TargetModel* model = nullptr;      ///< null: a target of tubes, or a panel
    const TargetSurface* surface = nullptr;      ///< a panel, whose phases may follow its ends
    std::vector<ChannelEnd> aims;  ///< the antennas of its `steer`, from and to, where it names some
  };
  struct End {
    std::unique_ptr<ChannelPaths> legs;
    uint32_t node = 0;
    uint64_t number = 0;          ///< of its name, for draws
    ChannelPaths::Result solved;  ///< [points_]
  };
  Target make_target(const TargetConfig& config, uint64_t seed) const;
  bool touches_target(const rf::Path& path) const;
  void make_legs(scene::GpuScene& gpu_scene, rf::CrossingPass& crossings);
  std::shared_ptr<const rf::TargetModel> surface_at(const Target& target, const rf::EndState& centre,
                                                    const TickContext& context) const;
  void make_tubes(scene::GpuScene& gpu_scene, const rf::ChannelGrid& grid);
  void add_echoes_of(size_t point, const End& from, const End& to, std::vector<rf::Path>& paths);

  const Experiment& experiment_;
  std::shared_ptr<RadioWorld> radio_;
  ChannelConfig leg_config_;  ///< the channel's, with the limits of legs
  std::vector<Target> targets_;
  std::vector<size_t> points_;                    ///< the targets that are points
  std::unique_ptr<TubeEchoes> tubes_;             ///< null: there is no other target
  std::vector<End> ends_;                         ///< every antenna of the channel once
  std::vector<size_t> transmitters_, receivers_;  ///< indices into ends_
  std::vector<TargetState> states_;
  std::array<std::vector<TargetState>, slots_in_flight> states_in_flight_;
  std::vector<bool> of_target_;  ///< [bodies]
  std::array<uint32_t, slots_in_flight> sequence_in_flight_{};
  uint32_t sequence_ = 0;
  uint64_t echoes_ = 0, replaced_ = 0;
};

}  // namespace greatx::sim
