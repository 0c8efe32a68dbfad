// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Channel state information of one transmitter and its receivers: the paths of ChannelPaths, seen through the antennas.
#pragma once

#include <optional>
#include <vector>

#include "rf/antenna/antenna.h"
#include "rf/channel/dispersion.h"
#include "rf/channel/frequency_response.h"
#include "sim/channel_paths.h"
#include "sim/effect_plan.h"
#include "sim/sensor.h"
#include "sim/world.h"

namespace greatx::sim {

class ChannelSensor : public Sensor {
 public:
  /// As ChannelPaths. Throws UserError, too, if receivers differ in their number of ports.
  ChannelSensor(scene::GpuScene& gpu_scene, rf::CrossingPass& crossings, const EffectPlan& plan,
                const Scenario& scenario, const World& world, uint32_t channel);

  const SensorSpec& spec() const override { return spec_; }
  void start(const TickContext& context) override { paths_.start(context); }
  void record(gpu::TickSlot& slot, const TickContext& context) override { paths_.record(slot, context); }
  bool looks_ahead() const override { return paths_.looks_ahead(); }
  void record_ahead(gpu::TickSlot& slot, const TickContext& next) override {
    paths_.record_ahead(slot, next);
  }
  std::vector<Array> collect(const gpu::TickSlot& slot) override;
  void report(Consistency& consistency) const override {
    consistency.line_of_sight.add(line_of_sight_errors_);
  }
  void count(std::map<std::string, uint64_t>& counters) const override;
  void note(std::vector<std::pair<std::string, std::string>>& notes) const override;

 private:
  /// What an interaction touches, as ids on disk.
  struct Where {
    uint8_t type = 0;
    uint32_t facet = 0, element = 0, object = 0, material = 0;
  };
  void describe();
  Where where_of(const rf::Interaction& interaction) const;
  std::vector<Array> arrays_of(const ChannelPaths::Result& result) const;

  const World& world_;
  const ChannelConfig& config_;
  bool doppler_;
  ChannelPaths paths_;
  rf::AntennaArray transmitter_array_;
  std::vector<rf::AntennaArray> receiver_arrays_;
  rf::ChannelGrid grid_;
  std::optional<rf::Dispersion> dispersion_;  ///< none: materials as at the carrier
  SensorSpec spec_;
  ErrorStatistics line_of_sight_errors_;
};

}  // namespace greatx::sim
