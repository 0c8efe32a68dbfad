// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Notices sensors within walls: cameras, LiDARs and radars whose place is inside a solid, or beneath the
// ground, at a tick at which they are due. Channels look after their own ends (sim/channel/channel_paths.h),
// which they also place on surfaces.
#pragma once

#include <map>
#include <string>
#include <vector>

#include "sim/scenario/scenario.h"
#include "sim/world/tick_context.h"
#include "sim/world/world.h"

namespace greatx::sim {

/// Returns what a place is within, as in "inside 'house'" or "beneath 'ground'"; empty: neither. The point is
/// in local coordinates, and `own_body` carries it.
std::string within(const World& world, const dvec3& point, std::span<const Pose> body_poses,
                   uint32_t own_body);

class SensorPlaces {
 public:
  /// Both outlive this.
  SensorPlaces(const Scenario& scenario, const World& world);
  /// Looks at the sensor called "NODE/SENSOR", which is due; other names are left alone. The first time that
  /// one is within something, it is logged.
  void look(const std::string& name, const TickContext& context);
  /// Adds NAME.records_inside_solids of every sensor that was within something.
  void count(std::map<std::string, uint64_t>& counters) const;
  void warn(std::vector<std::string>& warnings) const;

 private:
  struct Place {
    uint32_t node = 0, body = 0;
    dvec3 mount{0.0};
    bool rests = false;  ///< its node never moves: one look is enough for a sequence
    uint64_t records = 0, inside = 0;
    uint32_t looked_in = ~0u;  ///< the sequence of the last look
    bool was_inside = false;
    std::string first;  ///< what it was within, and when
  };
  const World& world_;
  std::map<std::string, Place> places_;
};

}  // namespace greatx::sim
