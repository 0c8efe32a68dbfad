// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "apps/campaign/queue.h"
#include "apps/campaign/store.h"
#include "gpu/device.h"
#include "sim/experiment/experiment.h"

namespace greatx::apps {

/// Holds what a run has done.
struct CampaignRun {
  uint64_t done = 0, skipped = 0;  ///< units
  double seconds = 0.0;
  bool complete = true;               ///< false: the user has interrupted it; what is done stays
  std::vector<std::string> warnings;  ///< what was lost
};

/// Makes the units of a queue that are not complete yet, as long as there are some to take. Units of one cell
/// share its world, its passes and its searches; cells of one scene share the scene. A record of the run goes
/// into runs/ of the campaign's folder.
CampaignRun run_units(const OpenCampaign& open, const WorkQueue& queue, gpu::Device& device, uint32_t threads,
                      bool quiet);

}  // namespace greatx::apps
