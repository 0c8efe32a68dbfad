// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Computes the echoes of targets from their surfaces for the links of a channel (docs/targets.md). Each echo
// is a path with a place, a delay and a phase over the time samples of its own, so that turning parts shift
// frequencies.
#pragma once

#include <array>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "rf/channel/frequency_response.h"
#include "rf/geometry/path.h"
#include "rf/surface/surfaces.h"
#include "rf/targets/tubes/tube_targets.h"
#include "sim/channel/ends.h"

namespace greatx::sim {

/// Describes a target: its instance, and the node that carries it.
struct TubeTarget {
  uint32_t instance = 0, node = 0;
};

class TubeEchoes {
 public:
  /// `config` has the targets `targets` with these options. `grid` has its time samples. All arguments
  /// outlive this.
  TubeEchoes(scene::GpuScene& gpu_scene, const Experiment& experiment, const ChannelConfig& config,
             const rf::RadioSurfaces& surfaces, const rf::ChannelGrid& grid, std::vector<TubeTarget> targets,
             const TargetTubes& options);

  void record(gpu::TickSlot& slot, const TickContext& context);
  void collect(const gpu::TickSlot& slot);
  /// Adds the echoes of a link at the tick collected last.
  void add_echoes(size_t transmitter, size_t receiver, std::vector<rf::Path>& paths) const;

 private:
  struct InFlight {
    rf::TubeTargets::Pending rays;
    rf::EchoMotion motion;
    dvec3 transmitter{0.0}, receiver{0.0};
  };
  struct Link {
    ChannelEnd transmitter, receiver;
    std::unique_ptr<rf::TubeTargets> finder;
    std::array<InFlight, slots_in_flight> in_flight;
    std::vector<rf::Path> echoes;  ///< of the tick collected last
  };
  rf::EchoMotion motion_of(const Link& link, const TickContext& context) const;
  std::vector<rf::Path> paths_of(const Link& link, const InFlight& flight) const;

  const Experiment& experiment_;
  const ChannelConfig& config_;
  std::vector<double> times_s_;  ///< of the time samples
  std::vector<TubeTarget> targets_;
  std::vector<Link> links_;  ///< [rx, tx]
};

}  // namespace greatx::sim
