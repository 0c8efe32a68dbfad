// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Says what a campaign holds, from its index and a sample of its records:
//
//   index.sqlite                  ─► Quantities by split ─┐
//   some pictures, point clouds   ─► ClassBalance ────────┴► stats.json, stats.png ─► card.md, croissant
#pragma once

#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "apps/campaign/store.h"
#include "core/record.h"

namespace greatx::apps {

inline constexpr size_t split_count = std::size(sim::split_names);

/// The values of one quantity, by split.
struct Quantity {
  std::string name, label;                  ///< `label`: with the unit, for people
  std::vector<std::vector<double>> values;  ///< [splits], ascending
};

/// The shares of semantic classes in what one kind of sensor sees, by split.
struct ClassBalance {
  std::string kind;                  ///< camera: of pixels; lidar: of returns
  std::vector<std::string> classes;  ///< those that occur, the most frequent first
  std::vector<std::vector<double>>
      shares;  ///< [splits][classes]; empty: no record of the split was looked at
};

struct CampaignStats {
  std::vector<Quantity> quantities;  ///< those that the campaign has
  std::vector<ClassBalance> balances;
  nlohmann::json json;  ///< counts, shares and percentiles
};

/// Reads the index of a merged campaign, and up to `most_sampled` records of cameras and as many of LiDARs,
/// spread evenly over all. Throws UserError if there is no index.
CampaignStats campaign_stats(const OpenCampaign& open, uint64_t most_sampled, bool quiet);

/// Adds the class balances, and the visibility of boxes where cameras have them.
void add_samples(const OpenCampaign& open, uint64_t most_sampled, bool quiet, CampaignStats& stats);

/// Returns count, mean and percentiles of values that ascend.
nlohmann::json figures_of(const std::vector<double>& ascending);

/// Draws a histogram for each quantity, with a line for each split.
Array draw_stats(const OpenCampaign& open, const CampaignStats& stats);

/// Returns the data card: what the campaign is, how it was made, and its figures.
std::string data_card(const OpenCampaign& open, const CampaignStats& stats);
/// Returns the metadata in the vocabulary Croissant 1.0 of MLCommons, for index.csv.
nlohmann::json croissant(const OpenCampaign& open, const CampaignStats& stats);

/// Writes all files. Returns the text for the terminal.
std::string write_stats(const OpenCampaign& open, const CampaignStats& stats);

}  // namespace greatx::apps
