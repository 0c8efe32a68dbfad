// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Says what a campaign holds, from its index alone:
//
//   index.sqlite ─► Quantities by split ─► stats.json, stats.png ─► card.md, croissant.json
#pragma once

#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "apps/campaign/store.h"
#include "core/record.h"

namespace greatx::apps {

/// The values of one quantity, by split.
struct Quantity {
  std::string name, label;                  ///< `label`: with the unit, for people
  std::vector<std::vector<double>> values;  ///< [splits], ascending
};

struct CampaignStats {
  std::vector<Quantity> quantities;  ///< those that the campaign has
  nlohmann::json json;               ///< counts, shares and percentiles
};

/// Reads the index of a merged campaign. Throws UserError if there is none.
CampaignStats campaign_stats(const OpenCampaign& open);

/// Draws a histogram for each quantity, with a line for each split.
Array draw_stats(const OpenCampaign& open, const CampaignStats& stats);

/// Returns the data card: what the campaign is, how it was made, and its figures.
std::string data_card(const OpenCampaign& open, const CampaignStats& stats);
/// Returns the metadata in the vocabulary Croissant 1.0 of MLCommons, for index.csv.
nlohmann::json croissant(const OpenCampaign& open, const CampaignStats& stats);

/// Writes all files. Returns the text for the terminal.
std::string write_stats(const OpenCampaign& open, const CampaignStats& stats);

}  // namespace greatx::apps
