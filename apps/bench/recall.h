// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// `greatx bench --recall`: are greatx's specular paths all there, and each once? Held against the exhaustive
// reference (rf/reference/exhaustive_paths.h), for the guaranteed search and for plain shoot and bounce over
// the number of rays.
#pragma once

#include <cstdint>
#include <string>

#include "apps/console/session.h"

namespace greatx::apps {

struct RecallOptions {
  ScenarioOptions scenario;
  bool every_scene = true;  ///< no scenario was named: the room, the street canyon and the city
  RunOptions run;
  uint32_t receivers = 100;        ///< drawn from the scenario's seed
  std::string receiver_file;       ///< CSV of positions instead; empty: none
  uint32_t max_depth = 3;          ///< reflections + walls passed
  uint32_t max_transmissions = 0;  ///< walls passed
  uint32_t max_rays_log2 = 22;     ///< the curve's last point; 0: no curve
  bool json = false;
};

/// Prints the comparison. Throws Failed if the guaranteed search misses, doubles or invents a path.
void run_recall(const RecallOptions& options);

}  // namespace greatx::apps
