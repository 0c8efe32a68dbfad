// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// The ends of a channel: antennas on nodes, single elements of them, or bare points.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "core/vec.h"
#include "rf/paths/path_solver.h"
#include "sim/experiment/experiment.h"
#include "sim/sensors/sensor.h"

namespace greatx::sim {

struct ChannelEnd {
  std::string name;              ///< "node/sensor", or "point 17"
  std::optional<uint32_t> node;  ///< none: a point at rest
  Pose mount;                    ///< on its node; without a node: in the world
  uint32_t body = 0;             ///< that carries the node and does not hide it; 0: none
  bool rests = true;             ///< its node never moves
};

/// One transmitter and its receivers.
struct ChannelEnds {
  ChannelEnd transmitter;
  std::vector<ChannelEnd> receivers;
  /// Whether it is said and counted if an end stands inside something; once is enough for an end of several
  /// links.
  bool check_transmitter = true, check_receivers = true;
};

/// The antenna "node/sensor" of the scenario; it must exist.
ChannelEnd antenna_end(const Experiment& experiment, const std::string& name);
/// At rest in the world.
ChannelEnd point_end(const dvec3& point, size_t number);
/// The ends of a channel's links of transmitter number `transmitter`, which alone has the receivers checked
/// if it is 0.
ChannelEnds channel_ends(const Experiment& experiment, uint32_t channel, uint32_t transmitter);

/// Local coordinates, with the velocity that the node's turning gives to what is mounted off its origin.
rf::EndState state_of(const ChannelEnd& end, const World& world, const TickContext& context);
/// Straight from the nodes' poses: what the paths' own lengths are checked against. World, metres.
dvec3 world_position(const ChannelEnd& end, const TickContext& context);

}  // namespace greatx::sim
