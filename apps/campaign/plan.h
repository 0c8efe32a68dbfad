// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Says what a campaign costs before it is run: a few ticks of each cell are simulated and written.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include <nlohmann/json.hpp>

#include "apps/campaign/store.h"
#include "gpu/device.h"

namespace greatx::apps {

/// What a few ticks of a cell have cost.
struct CellCost {
  double start_s = 0.0;  ///< world, pipelines, searches, once for each process and cell
  double tick_s = 0.0;   ///< written, median
  double tick_bytes = 0.0;
};

/// Runs `ticks` ticks of a scenario into a folder that is removed afterwards.
CellCost measure_cell(const sim::Scenario& scenario, gpu::Device& device, int64_t ticks);

struct CampaignPlan {
  nlohmann::json json;
  std::string text;
};
/// Sums up. `costs`: [cells], or empty if nothing was measured. `cores`: of this machine, whose cores one run
/// keeps busy; the hours on others are those of as many shards.
CampaignPlan plan_of(const OpenCampaign& open, const std::vector<CellCost>& costs, uint32_t cores,
                     const std::vector<uint32_t>& other_cores);

}  // namespace greatx::apps
