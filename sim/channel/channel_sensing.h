// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Declares and fills the arrays that a channel senses: maps, detections, and the truth about its targets
// (docs/sensing.md). The symbols are the time samples of a record.
#pragma once

#include <complex>
#include <cstdint>
#include <map>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include <nlohmann/json_fwd.hpp>

#include "core/record.h"
#include "rf/channel/frequency_response.h"
#include "rf/sensing/ofdm_sensing.h"
#include "sim/channel/channel_targets.h"
#include "sim/plan/effect_plan.h"

namespace greatx::sim {

/// Holds one link at a tick.
struct SensedLink {
  std::span<const std::complex<float>> h;  ///< [rx_ant, tx_ant, time, subcarrier]
  std::span<const rf::Path> paths;
  rf::ArrayPose transmitter, receiver;
  rf::EndState transmitter_state, receiver_state;
};

class ChannelSensing {
 public:
  /// The channel has a block `sensing`. `targets`: the number of its targets, 0 without their echoes. Throws
  /// UserError as OfdmSensing does.
  ChannelSensing(const Experiment& experiment, const ChannelConfig& config, const rf::ChannelGrid& grid,
                 std::span<const rf::AntennaArray> transmitters, std::span<const rf::AntennaArray> receivers,
                 size_t targets);

  /// Adds the arrays to the spec, and the facts about them to the metadata.
  void describe(SensorSpec& spec) const;
  void describe(nlohmann::json& metadata) const;

  /// Returns the arrays of a record in the order described. `links`: [rx, tx].
  std::vector<Array> arrays_of(std::span<const SensedLink> links, std::span<const TargetState> targets,
                               uint32_t sequence, int64_t tick);
  bool detects() const { return config_.detections; }

  void count(std::map<std::string, uint64_t>& counters) const;
  /// Adds a warning if echoes of targets lay beyond the spans of range or velocity.
  void warn(std::vector<std::string>& warnings) const;

 private:
  struct Truth;
  /// Holds what all links of a record have sensed.
  struct Sensed;
  const rf::OfdmSensing& of_link(size_t receiver, size_t transmitter) const {
    return *links_[receiver * transmitters_ + transmitter];
  }
  Truth truth_of(const rf::OfdmSensing& sensing, const SensedLink& link, const TargetState& target,
                 std::span<const rf::SensingTone> tones, std::span<const rf::SensingDetection> found) const;
  std::vector<rf::SensingTone> tones_of(const SensedLink& link) const;
  void sense(size_t index, const SensedLink& link, std::span<const TargetState> targets, uint32_t sequence,
             int64_t tick, Sensed& sensed);
  void add_detections(const Sensed& sensed, std::vector<Array>& arrays) const;
  void add_truth(const Sensed& sensed, std::vector<Array>& arrays) const;
  void note_aliases(const rf::OfdmSensing& sensing, std::span<const rf::SensingTone> tones);

  std::string name_;
  rf::SensingConfig config_;
  double carrier_hz_;
  uint64_t seed_;
  size_t transmitters_, receivers_, targets_;
  std::vector<std::unique_ptr<rf::OfdmSensing>> links_;  ///< [rx, tx]
  uint64_t bursts_ = 0, detections_ = 0, saturated_ = 0, aliased_ = 0;
  double longest_range_m_ = 0.0, fastest_m_s_ = 0.0;  ///< of aliased echoes
};

}  // namespace greatx::sim
