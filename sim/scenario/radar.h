// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// nodes[].sensors[] of type radar, as the user wrote it (docs/scenario.md).
#pragma once

#include <string>
#include <vector>

#include "core/error.h"
#include "rf/config/echo_options.h"
#include "rf/config/radar_config.h"
#include "sim/scenario/antenna.h"

namespace greatx::sim {

struct RadarConfig {
  rf::RadarSignalConfig signal;  ///< of arrays, those below at the carrier
  AntennaConfig transmit, receive;
  /// "node/sensor", an antenna of another node that transmits instead of `transmit`; empty: monostatic.
  std::string illuminator;
  SourceLocation illuminator_where;
  rf::EchoOptions echoes;            ///< as far as a scenario says it
  std::vector<std::string> targets;  ///< instances that get fine tubes though they do not move
  /// How often the scene is traced over a frame, at the beginnings of equal runs of chirps: once for what a frame does not
  /// turn, more for rotors.
  uint32_t updates = 1;
  bool see_own_body = false;
  struct Outputs {
    bool cube = false, range_doppler = true, range_azimuth = true, detections = true;
  } outputs;
};

}  // namespace greatx::sim
