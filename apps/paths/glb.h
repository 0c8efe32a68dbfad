// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Paths as a glTF binary, for other programs.
#pragma once

#include <span>
#include <string>

#include "core/vec.h"
#include "draw/paths/draw.h"
#include "io/files/file.h"

namespace greatx::apps {

/// What the file says of itself, and whether the scene goes with it.
struct PathGlbOptions {
  PathColors colors = PathColors::gain;
  std::string name = "paths";
  int64_t tick = 0;
  double time_s = 0.0;
  double marker_m = 0.5;         ///< radius of the markers at interactions
  std::span<const Pose> bodies;  ///< [bodies] local coordinates: with the scene's triangles; empty: without
};

/// Coordinates are local (world - origin; the origin stands in the scene's extras), so that fp32 keeps them: nodes
///   paths                       extras: carrier, tick, origin
///     RECEIVER                  extras: index, position, distance, gain, delay spread
///       path N CHAIN ID         a mesh of lines, and of markers at its interactions; extras: id, chain, length_m,
///                               delay_s, gain_db, doppler_hz
///   transmitter, receivers      markers
///   scene                       one node an instance, plain base colours, at the tick's poses
/// Lines are unlit and carry their colour in COLOR_0.
io::Bytes paths_glb(std::span<const PathLink> links, const PathScene& scene, const PathGlbOptions& options);

}  // namespace greatx::apps
