// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Makes the cells of a campaign: a choice of a value for every axis, with the scenario that follows from it.
#pragma once

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "sim/campaign/campaign.h"
#include "sim/scenario/scenario.h"

namespace greatx::sim {

/// Holds a base scenario as somebody wrote it.
struct BaseScenario {
  std::string text, name;        ///< `name`: of the file, for messages
  std::filesystem::path folder;  ///< where relative paths begin
  std::filesystem::path assets;  ///< where they are looked for next
};
/// Returns the base scenario of this name. Throws UserError if there is none.
using FindBase = std::function<BaseScenario(const std::string& name)>;

struct CampaignCell {
  std::string name;            ///< the names of the values, joined by dots; "all" without axes
  std::vector<size_t> values;  ///< [axes]
  Scenario scenario;           ///< complete; its name is the cell's
};

/// Returns all cells in the order of the axes, the last one running fastest, without those that are excluded.
/// Throws UserError, which names the campaign's line, if a change leads nowhere or makes a faulty scenario,
/// if nothing is left, or if an exclusion leaves nothing out.
std::vector<CampaignCell> campaign_cells(const Campaign& campaign, const FindBase& find_base);

/// Returns a scenario's text with this many sequences. It is what a unit's files say of their run: the
/// sequence `count` - 1 has the same bytes, however many more there are.
Scenario with_sequences(const Scenario& scenario, uint32_t count);

}  // namespace greatx::sim
