// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Computes the channel state information between the transmitters and receivers of a channel from the paths
// of ChannelPaths and the antennas.
#pragma once

#include <array>
#include <memory>
#include <optional>
#include <vector>

#include "rf/channel/dispersion.h"
#include "rf/channel/frequency_response.h"
#include "sim/channel/blocks.h"
#include "sim/channel/channel_paths.h"
#include "sim/channel/channel_sensing.h"
#include "sim/channel/channel_targets.h"
#include "sim/channel/columns.h"
#include "sim/channel/element_paths.h"
#include "sim/channel/link_ends.h"
#include "sim/experiment/experiment.h"
#include "sim/sensors/sensor.h"

namespace greatx::sim {

/// A channel as a sensor of a run: frequency responses, taps, link statistics and paths.
class ChannelSensor : public Sensor {
 public:
  /// Throws UserError like ChannelPaths, and if the transmitters or the receivers differ in their number of
  /// ports. `radio` is the channel's world. All arguments but `channel` outlive this.
  ChannelSensor(scene::GpuScene& gpu_scene, rf::CrossingPass& crossings, const Experiment& experiment,
                uint32_t channel, std::shared_ptr<RadioWorld> radio);

  const SensorSpec& spec() const override { return spec_; }
  void start(const TickContext& context) override;
  void record(gpu::TickSlot& slot, const TickContext& context) override;
  bool looks_ahead() const override;
  void record_ahead(gpu::TickSlot& slot, const TickContext& next) override;
  std::vector<Array> collect(const gpu::TickSlot& slot) override;
  Evidence evidence() const override;
  void count(std::map<std::string, uint64_t>& counters) const override;
  void warn(std::vector<std::string>& warnings) const override;
  void note(std::vector<std::pair<std::string, std::string>>& notes) const override;

 private:
  using Results = std::vector<ChannelPaths::Result>;  ///< [tx]
  /// Describes a link between arrays whose ends may be in their near field.
  struct NearLink {
    size_t receiver = 0, transmitter = 0;
    double within_m = 0.0;                   ///< below this distance every pair of elements is solved
    std::unique_ptr<ElementPaths> elements;  ///< null until the distance first is below
    std::array<bool, slots_in_flight> recorded{};
  };
  void find_near_links();
  std::unique_ptr<ElementPaths> make_elements(const NearLink& link) const;
  /// Returns the element paths of a link if it was solved by elements at the tick of `slot`; else null.
  const ElementPaths* elements_of(size_t receiver, size_t transmitter, uint32_t slot) const;
  void describe();
  std::string metadata() const;
  void check_sights(const Results& results);
  std::vector<Array> arrays_of(const Results& results, uint32_t slot) const;
  struct LinkFacts;
  LinkFacts facts_of(const Results& results, size_t receiver, size_t transmitter, uint32_t slot) const;
  LinkEnds ends_of(const Results& results, size_t receiver, size_t transmitter) const;
  /// Adds what the channel senses with its responses, of which `arrays` may hold the first block.
  void add_sensed(const Results& results, uint32_t slot, std::vector<Array>& arrays) const;
  Array block_of(const PortBlock& block, const Results& results, uint32_t slot) const;

  scene::GpuScene& gpu_scene_;
  rf::CrossingPass& crossings_;
  const Experiment& experiment_;
  uint32_t channel_;
  const ChannelConfig& config_;
  bool doppler_;
  std::shared_ptr<RadioWorld> radio_;
  std::vector<std::unique_ptr<ChannelPaths>> paths_;  ///< [tx]
  std::unique_ptr<ChannelTargets> targets_;           ///< null: no echoes of targets
  std::unique_ptr<ChannelSensing> sensing_;           ///< null: it senses nothing
  /// Describes the tick in each slot, for the draws of noise.
  struct Moment {
    uint32_t sequence = 0;
    int64_t tick = 0;
  };
  std::array<Moment, slots_in_flight> moments_;
  std::vector<rf::AntennaArray> transmitter_arrays_, receiver_arrays_;
  std::vector<NearLink> near_links_;
  bool told_near_ = false;
  uint64_t near_ticks_ = 0;  ///< number of (link, tick) pairs solved by elements
  LinkLeftOut left_out_of_elements_;
  rf::ChannelGrid grid_;
  std::optional<rf::Dispersion> dispersion_;  ///< none: materials have their values at the carrier
  ColumnContext columns_;
  std::vector<PortBlock> blocks_;
  std::vector<LinkColumn> link_columns_;
  std::vector<PathColumn> path_columns_;
  SensorSpec spec_;
  /// Errors of the record collected last: c times the delay of direct paths against the distance of the ends.
  ErrorStatistics sights_;
};

}  // namespace greatx::sim
