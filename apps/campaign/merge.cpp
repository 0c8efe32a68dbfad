// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "apps/campaign/merge.h"

#include <algorithm>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "apps/files/consistency_files.h"
#include "io/files/file.h"
#include "io/files/untrusted_json.h"
#include "sim/dataset/dataset_info.h"

namespace greatx::apps {

namespace fs = std::filesystem;

namespace {

/// Reads what the first sequence of a cell says of its run.
io::DatasetInfo stored_info(const OpenCampaign& open, size_t cell) {
  const fs::path merged = open.data(cell) / io::dataset_file;
  std::error_code ignored;
  const fs::path file = fs::exists(merged, ignored) ? merged : open.part({cell, 0}) / io::dataset_file;
  if (!fs::exists(file, ignored))
    throw_user_error("{}: cell '{}': expected sequence 0, complete; found it missing", open.folder.string(),
                     open.cells[cell].name);
  return io::parse_dataset_json(io::read_text_file(file, io::JsonLimits{}.bytes), file.string());
}

/// Joins what the parts say of their consistency into the file of the data set.
void join_consistency(const OpenCampaign& open, size_t cell) {
  std::vector<sim::ConsistencyRow> rows;
  for (uint32_t s = 0; s < open.sequences(cell); ++s) {
    const fs::path file = consistency_of(open.journals(cell), s);
    std::error_code ignored;
    if (!fs::exists(file, ignored)) continue;
    const auto own = parse_consistency_csv(io::read_text_file(file), file.string());
    rows.insert(rows.end(), own.begin(), own.end());
  }
  io::write_file_atomically(open.data(cell) / io::consistency_file, consistency_csv(rows));
}

void check_folder(const OpenCampaign& open, const fs::path& folder) {
  const nlohmann::json cells = known_cells(open.folder), others = known_cells(folder);
  if (others.empty())
    throw_user_error("--from: {}: expected the folder of a campaign, found no cells.json", folder.string());
  for (const auto& [name, identity] : others.items())
    if (const auto known = cells.find(name); known != cells.end() && *known != identity)
      throw_user_error("--from: {}: cell '{}' has another scenario than in {}", folder.string(), name,
                       open.folder.string());
}

}  // namespace

void gather_parts(const OpenCampaign& open, const std::vector<fs::path>& folders) {
  struct Move {
    fs::path from, to, csv_from, csv_to;
  };
  if (folders.empty()) return;
  std::vector<Move> moves;
  for (const fs::path& folder : folders) check_folder(open, folder);
  for (const CampaignUnit& unit : open.units()) {
    std::vector<fs::path> holders;
    if (open.state(unit).begun) holders.push_back(open.folder);
    for (const fs::path& folder : folders) {
      OpenCampaign other = open;
      other.folder = folder;
      if (!other.state(unit).complete) continue;
      holders.push_back(folder);
      moves.push_back({other.part(unit), open.part(unit),
                       consistency_of(other.journals(unit.cell), unit.sequence),
                       consistency_of(open.journals(unit.cell), unit.sequence)});
    }
    if (holders.size() > 1)
      throw_user_error("{} and {} both hold sequence {} of cell '{}': shards overlapped; remove one of them",
                       holders[0].string(), holders[1].string(), unit.sequence, open.cells[unit.cell].name);
  }
  for (const Move& part : moves) {
    std::error_code ignored;
    io::create_folders(part.csv_to.parent_path());
    io::create_folders(part.to.parent_path());
    if (fs::exists(part.csv_from, ignored))
      fs::copy_file(part.csv_from, part.csv_to, fs::copy_options::overwrite_existing);
    io::move_folder(part.from, part.to);
  }
}

bool merge_cell(const OpenCampaign& open, size_t cell) {
  const sim::Scenario& scenario = open.cells[cell].scenario;
  const io::DatasetInfo stored = stored_info(open, cell);
  const auto info_of = [&](uint32_t count) {
    return sim::with_sequences(stored, sim::with_sequences(scenario, count));
  };
  if (open.merged(cell) && stored.sequences == scenario.sequences) return false;
  io::assemble({.folder = open.data(cell),
                .journals = open.journals(cell),
                .info = info_of(scenario.sequences),
                .part_info = info_of,
                .part = [&](uint32_t sequence) {
                  return open.part({cell, sequence});
                }});
  join_consistency(open, cell);
  return true;
}

void write_splits(const OpenCampaign& open) {
  std::string csv = "cell,sequence,split\n";
  for (const CampaignUnit& unit : open.units()) {
    const sim::CampaignCell& cell = open.cells[unit.cell];
    const sim::Split split = sim::split_of(open.campaign, cell.values, unit.sequence);
    csv += fmt::format("{},{},{}\n", cell.name, unit.sequence, sim::split_names[static_cast<size_t>(split)]);
  }
  io::write_file_atomically(open.folder / "splits.csv", csv);
}

}  // namespace greatx::apps
