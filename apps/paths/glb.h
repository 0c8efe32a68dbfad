// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Exports paths as a glTF binary for other programs.
#pragma once

#include <span>
#include <string>

#include "core/vec.h"
#include "draw/paths/draw.h"
#include "io/files/file.h"

namespace greatx::apps {

/// Holds the colours, the description of the file, and the poses of the scene if it is exported too.
struct PathGlbOptions {
  PathColors colors = PathColors::gain;
  std::string name = "paths";
  int64_t tick = 0;
  double time_s = 0.0;
  double marker_m = 0.5;  ///< radius of the markers at interactions
  /// Poses of the scene's bodies in local coordinates, [bodies]; empty: the scene is not exported.
  std::span<const Pose> bodies;
};

/// Returns the paths as a glTF binary. Coordinates are local (world - origin), so that fp32 holds them
/// precisely; the origin is in the extras of the glTF scene. The nodes are:
///   paths                 extras: carrier, tick, time, origin
///     paths to RECEIVER   extras: index, position, distance, number of paths, line of sight, gain, delay
///                         spread
///       path N CHAIN ID   a mesh of lines, and of markers at the interactions; extras: id, chain,
///                         interactions, length_m, delay_s, doppler_hz, gain_db
///   transmitter           marker
///   RECEIVER              marker, one for each receiver
///   scene                 one node for each instance, in plain base colours, at the poses of the tick
/// Lines are unlit and have their colour in COLOR_0.
io::Bytes paths_glb(std::span<const PathLink> links, const PathScene& scene, const PathGlbOptions& options);

}  // namespace greatx::apps
