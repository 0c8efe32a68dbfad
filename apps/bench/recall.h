// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// `greatx bench --recall`: checks that greatx finds every specular path, and every path over an edge if asked
// to, exactly once. Both the guaranteed
// search and plain shooting and bouncing of rays, for increasing numbers of rays, are compared with the
// exhaustive reference (rf/reference/exhaustive_paths.h).
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "apps/bench/recall_scene.h"
#include "apps/console/session.h"

namespace greatx::apps {

struct RecallOptions {
  ScenarioOptions scenario;
  bool every_scene = true;  ///< instead of `scenario`, use the room, the street canyon and the city
  RunOptions run;
  uint32_t receivers = 100;   ///< number of receivers, drawn from the scenario's seed
  std::string receiver_file;  ///< CSV of positions to use instead; empty: none
  RecallPaths paths;
  uint32_t max_rays_log2 =
      22;  ///< log2 of the largest number of rays; below 14: no rays are shot. Paths over edges need
           ///< beams
  std::vector<uint32_t> budgets{500, 1000, 2000, 4000};  ///< of scatterings, if these are asked for
  bool json = false;
};

/// Prints the comparison, or that of scatterings if they are asked for (scatter_recall.h). Throws Failed if
/// the guaranteed search misses a path, doubles one, or finds one that the reference does not have.
void run_recall(const RecallOptions& options);

}  // namespace greatx::apps
