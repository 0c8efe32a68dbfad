// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// The folder of a campaign:
//
//   OUT/campaign.yaml            the campaign as it was run last
//   OUT/cells.json               the scenario of each cell, as a hash: a cell never changes
//   OUT/parts/CELL/0007/         sequence 7 of a cell while it is made, and until it is merged
//   OUT/journals/CELL/           what is known of the sequences that are merged
//   OUT/data/CELL/               the data set of a cell
//   OUT/index.sqlite, index.csv  every record of the campaign
//
// Shards may share the folder, over a network file system too: each part belongs to one of them, and a part
// is locked while it is written.
#pragma once

#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "io/dataset/part.h"
#include "sim/campaign/cells.h"

namespace greatx::apps {

/// A sequence of a cell.
struct CampaignUnit {
  size_t cell = 0;
  uint32_t sequence = 0;
};

/// Holds a campaign with its cells, and where its files are.
struct OpenCampaign {
  sim::Campaign campaign;
  std::vector<sim::CampaignCell> cells;
  std::filesystem::path folder;

  std::filesystem::path part(const CampaignUnit& unit) const;
  std::filesystem::path journals(size_t cell) const;
  std::filesystem::path data(size_t cell) const;
  bool merged(size_t cell) const;  ///< whether the cell has a finished data set
  /// Returns the state of a unit; merged units are complete.
  io::PartState state(const CampaignUnit& unit) const;
  uint32_t sequences(size_t cell) const { return cells[cell].scenario.sequences; }
  /// All units, cell by cell.
  std::vector<CampaignUnit> units() const;
};

/// Returns the file that keeps what a sequence says of the consistency of its sensors.
std::filesystem::path consistency_of(const std::filesystem::path& journals, uint32_t sequence);

/// Chooses cells and units by the command line.
struct CampaignOptions {
  std::string file, output, assets;
  std::vector<std::string> cells;  ///< only these; empty: all
};

/// Returns the names of the embedded campaigns, with commas between them.
std::string embedded_campaign_names();

/// Tells whether a name is that of an embedded campaign, or a file that says so itself.
bool is_campaign(const std::string& file);

/// Reads a campaign and makes its cells. Throws UserError as parse_campaign() and campaign_cells() do, and if
/// a cell of --cell does not exist.
OpenCampaign open_campaign(const CampaignOptions& options);

/// Returns the scenarios' hashes by the names of the cells that a folder knows: an empty object if it knows
/// none. Throws UserError if its cells.json is no object.
nlohmann::json known_cells(const std::filesystem::path& folder);

/// Writes campaign.yaml and cells.json. Throws UserError if a cell of the folder had another scenario: the
/// campaign has changed. New cells and more sequences are no change.
void claim_folder(const OpenCampaign& open);

/// A part of the units: `index` of `count`, from 1 on.
struct Shard {
  uint32_t index = 1, count = 1;
};
/// Parses "2/8". Throws UserError.
Shard parse_shard(const std::string& text);
/// Returns the units of a shard: a range, so that a shard has few cells. The ranges of all shards hold every
/// unit once.
std::span<const CampaignUnit> units_of(std::span<const CampaignUnit> units, const Shard& shard);

}  // namespace greatx::apps
