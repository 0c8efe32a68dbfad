// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Defines the ends of a channel: antennas on nodes, single elements of antennas, or points.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "core/vec.h"
#include "rf/paths/path_solver.h"
#include "sim/experiment/experiment.h"
#include "sim/sensors/sensor.h"

namespace greatx::sim {

/// Describes one end.
struct ChannelEnd {
  std::string name;              ///< "node/sensor", or "point 17"
  std::optional<uint32_t> node;  ///< none: a point at rest
  Pose mount;                    ///< relative to its node; without a node: to the world
  uint32_t body = 0;             ///< the body that carries the node and does not block it; 0: none
  bool rests = true;             ///< its node never moves
  uint32_t elements = 1;         ///< of its antenna
  int64_t height_mm = 0;         ///< of its antenna in the world, if it rests; otherwise 0
};

/// Returns the end of a link that the search starts from if paths with a diffraction or a scattering would
/// differ by it (PathLimits). The choice does not depend on which end transmits, nor on the other ends of the
/// channel: it is the end that rests; else the one whose antenna has more elements; else, if both rest, the
/// higher one, by whole millimetres; else the one whose name comes first in the order of bytes. Elements and
/// height mostly name a base station, whose one search then serves many links.
rf::Source searched_from(const ChannelEnd& transmitter, const ChannelEnd& receiver);

/// Holds one transmitter and its receivers.
struct ChannelEnds {
  ChannelEnd transmitter;
  std::vector<ChannelEnd> receivers;
  /// Whether an end inside a solid is reported and counted. One check is enough for an end of several links.
  bool check_transmitter = true, check_receivers = true;
};

/// Returns the end at the antenna "node/sensor" of the scenario. The antenna must exist.
ChannelEnd antenna_end(const Experiment& experiment, const std::string& name);
/// Returns an end at rest in the world, called "point N".
ChannelEnd point_end(const dvec3& point, size_t number);
/// Returns the ends of the links of transmitter number `transmitter`. Only transmitter 0 has its receivers
/// checked.
ChannelEnds channel_ends(const Experiment& experiment, uint32_t channel, uint32_t transmitter);

/// Returns the state of an end in local coordinates. Its velocity includes the contribution of the node's
/// rotation to an end that is mounted off the node's origin.
rf::EndState state_of(const ChannelEnd& end, const World& world, const TickContext& context);
/// Returns the world position of an end, metres, directly from the poses of the nodes. The lengths of paths
/// are checked against these positions.
dvec3 world_position(const ChannelEnd& end, const TickContext& context);

}  // namespace greatx::sim
