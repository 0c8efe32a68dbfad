// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// `greatx bench --recall`: checks that greatx finds every specular path exactly once. It compares with the
// exhaustive reference (rf/reference/exhaustive_paths.h) the guaranteed search, and plain shooting and
// bouncing of rays for increasing numbers of rays.
#pragma once

#include <cstdint>
#include <string>

#include "apps/console/session.h"

namespace greatx::apps {

struct RecallOptions {
  ScenarioOptions scenario;
  bool every_scene = true;  ///< instead of `scenario`, use the room, the street canyon and the city
  RunOptions run;
  uint32_t receivers = 100;        ///< number of receivers, drawn from the scenario's seed
  std::string receiver_file;       ///< CSV of positions to use instead; empty: none
  uint32_t max_depth = 3;          ///< largest number of reflections and transmissions of a path
  uint32_t max_transmissions = 0;  ///< largest number of transmissions of a path
  uint32_t max_rays_log2 = 22;     ///< log2 of the largest number of rays; below 14: no rays are shot
  bool json = false;
};

/// Prints the comparison. Throws Failed if the guaranteed search misses a path, doubles one, or finds one
/// that the reference does not have.
void run_recall(const RecallOptions& options);

}  // namespace greatx::apps
