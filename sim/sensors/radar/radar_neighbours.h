// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Follows the other radars whose ramps reach a radar: when they send, where they are, and whether anything is
// between.
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "rf/radar/echoes/echo_finder.h"
#include "rf/radar/signal/interference.h"
#include "sim/experiment/experiment.h"
#include "sim/sensors/sensor.h"

namespace greatx::sim {

/// Frame f of another radar begins f/rate_hz after the start of the run, and later by an offset between 0 and
/// the time from one of a transmitter's ramps to its next. The offset and the phase between both oscillators
/// are drawn afresh for each frame.
class RadarNeighbours {
 public:
  /// `name` is that of the radar that is disturbed.
  RadarNeighbours(const Experiment& experiment, const RadarConfig& config, const std::string& name);

  bool empty() const { return others_.empty(); }

  /// A frame of another radar that is on its way during the slots of an update.
  struct Sent {
    uint32_t other = 0;
    Pose pose;                  ///< of the transmitter when the scene is traced
    rf::Interferer interferer;  ///< without amplitude
  };
  std::vector<Sent> record(const TickContext& context, const rf::EchoMotion& motion) const;
  /// Returns those that nothing hides. `rays` is the tracing of the update.
  std::vector<rf::Interferer> arrive(std::span<const Sent> sent, rf::EchoFinder& finder,
                                     const rf::EchoFinder::Pending& rays);

  /// Counts what a frame took from its interferers.
  void count(std::span<const rf::Interferer> interferers, std::span<const rf::InterferenceReport> reports,
             uint64_t samples);
  void note(const std::string& radar, std::vector<std::pair<std::string, std::string>>& notes) const;

 private:
  struct Other {
    std::string name;
    uint32_t node = 0;
    Pose mount;
    double period_s = 0.0;
    rf::EchoEnd end;
    rf::RadarSignalConfig signal;
    uint64_t frames = 0, hidden = 0, samples = 0;  ///< of updates
    double strongest_w = 0.0;                      ///< power at the receiver's port
  };
  double offset_s(const Other& other, int64_t frame, double& phase_turns) const;

  const World& world_;
  std::string name_;
  uint64_t seed_;
  std::vector<Other> others_;
  uint64_t all_samples_ = 0;
};

}  // namespace greatx::sim
