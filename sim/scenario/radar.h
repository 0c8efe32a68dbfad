// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Defines a sensor of type radar in nodes[].sensors[], as the user wrote it (docs/scenario.md).
#pragma once

#include <string>
#include <vector>

#include "core/error.h"
#include "rf/config/echo_options.h"
#include "rf/config/radar_config.h"
#include "sim/scenario/antenna.h"

namespace greatx::sim {

struct RadarConfig {
  rf::RadarSignalConfig signal;  ///< its arrays are those below, at the carrier
  AntennaConfig transmit, receive;
  /// "node/sensor" of an antenna of another node that transmits instead of `transmit`. Empty: the radar is
  /// monostatic.
  std::string illuminator;
  SourceLocation illuminator_where;
  rf::EchoOptions echoes;            ///< the options that a scenario has
  std::vector<std::string> targets;  ///< instances looked for over mirrors though they do not move
  /// How often the scene is traced over a frame, at the beginnings of equal runs of chirps. Once is enough
  /// for bodies that hardly turn during a frame; rotors need more.
  uint32_t updates = 1;
  /// "node/sensor" of the radars whose transmitters disturb this one; empty: none does.
  std::vector<std::string> interferers;
  struct Interference {
    SourceLocation where;
    bool all = false;  ///< all other radars, until resolve_interferers() has named them
  } interference;
  bool see_own_body = false;
  struct Outputs {
    bool cube = false, range_doppler = true, range_azimuth = true, detections = true;
  } outputs;
};

}  // namespace greatx::sim
