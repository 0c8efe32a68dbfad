// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Describes a campaign: many data sets from one file. Data flows one way:
//
//   campaign.yaml ─► Campaign ─► campaign_cells() ─► cells, each with the text of a scenario
//                                     │
//                   units (a sequence of a cell) ─► apps/campaign runs, merges and indexes them
//
// A cell is one choice of a value for every axis. Its scenario is the base scenario with the changes of these
// values, and with as many sequences as the campaign asks for. A unit is one sequence of a cell. Its bytes
// depend on the cell's scenario and on its number alone, so that units may run in any order, on any machine,
// and more of them may be added later.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "core/error.h"

namespace greatx::sim {

/// Gives a place of a scenario another value. The value is YAML on one line; an empty one takes the place
/// away.
struct CampaignChange {
  std::string path;  ///< e.g. "nodes[uav].model"; items of lists by their number or by their name
  std::string value;
  SourceLocation where;
};

struct CampaignValue {
  std::string name;
  std::string base;  ///< the base scenario of cells with this value; empty: that of the campaign
  std::optional<uint32_t> sequences;  ///< of cells with this value; none: as the campaign says
  std::vector<CampaignChange> changes;
  SourceLocation where;
};

struct CampaignAxis {
  std::string name;
  std::vector<CampaignValue> values;
};

enum class Split : uint8_t { train, validation, test };
inline constexpr const char* split_names[] = {"train", "validation", "test"};

/// Says which records are for training, validation and test. No trajectory is in two of them.
struct CampaignSplit {
  std::optional<size_t> axis;            ///< by the values of this axis; none: by sequence
  std::vector<Split> of_value;           ///< [values of the axis]
  double train = 0.8, validation = 0.1;  ///< shares of the sequences; the rest is for test
};

/// Leaves out cells: those that have one of the values for every axis that it names.
struct CampaignExclusion {
  std::vector<std::pair<size_t, std::vector<size_t>>> values;  ///< axis, values
  SourceLocation where;
};

/// What the data card says of a campaign, as its makers state it.
struct CampaignCard {
  std::string description, license, citation;
  std::vector<std::string> creators;
};

struct Campaign {
  std::string name, text;
  std::string file;                     ///< for messages
  std::filesystem::path folder;         ///< where relative paths begin
  std::string base;                     ///< a scenario file, or the name of an embedded one
  std::vector<CampaignChange> changes;  ///< of every cell, before those of the axes
  std::vector<CampaignAxis> axes;
  std::vector<CampaignExclusion> exclusions;
  uint32_t sequences = 1;  ///< of each cell
  CampaignSplit split;
  CampaignCard card;
  std::optional<double> most_hours, most_gigabytes;  ///< the budget
};

/// Reads a campaign. Throws UserError "file:line: field: expected ..., found ..." at the first fault: unknown
/// keys, axes that name nothing, splits that leak.
Campaign parse_campaign(const std::string& text, const std::string& file,
                        const std::filesystem::path& folder);

/// Returns the split of a sequence of the cell with these values. It depends on the number of the sequence
/// and not on how many there are, and is the same in all cells, whose sequences with one number fly one
/// trajectory. The shares of any n numbers that follow one another are off by 2/n at most, or little more.
Split split_of(const Campaign& campaign, const std::vector<size_t>& values, uint32_t sequence);

}  // namespace greatx::sim
