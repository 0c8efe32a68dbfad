// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "apps/campaign/store.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <optional>
#include <unistd.h>

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <nlohmann/json.hpp>
#include <spdlog/spdlog.h>

#include "apps/console/json_text.h"
#include "assets/assets.h"
#include "core/hash.h"
#include "core/input_file.h"
#include "core/text.h"
#include "io/files/file.h"

namespace greatx::apps {

namespace fs = std::filesystem;

namespace {

constexpr const char* cells_file = "cells.json";

bool is_there(const fs::path& path) {
  std::error_code ignored;
  return fs::exists(path, ignored);
}

std::string identity_of(const sim::CampaignCell& cell) {
  return Sha256().update(sim::with_sequences(cell.scenario, 1).text).hex();
}

/// Writes a file that other shards, on other machines too, may write in the same moment.
void write_among_shards(const fs::path& file, const std::string& text) {
  if (is_there(file) && io::read_text_file(file) == text) return;
  std::array<char, 256> host{};
  ::gethostname(host.data(), host.size() - 1);
  fs::path own = file;
  own += fmt::format(".{}.{}", host.data(), ::getpid());
  io::write_file_atomically(own, text);
  io::rename_file(own, file);
}

/// Tells whether a text has the key by which campaigns name their format.
bool is_campaign_text(std::string_view text) {
  constexpr std::string_view key = "\ngreatx_campaign:";
  return text.starts_with(key.substr(1)) || text.find(key) != std::string_view::npos;
}

/// Returns the text of an embedded file of assets/campaigns, with or without its extension.
std::optional<std::string> embedded_text(const std::string& name) {
  for (const EmbeddedScenario& embedded : embedded_campaigns())
    if (name == embedded.name || name == fmt::format("{}.yaml", embedded.name))
      return std::string(embedded.text);
  return {};
}

/// Returns a base scenario: an embedded one, or a file, relative to the campaign's folder or among the
/// assets. An embedded campaign has its base beside it in the program.
sim::BaseScenario base_scenario(const std::string& name, const fs::path& folder, const fs::path& assets,
                                bool of_embedded) {
  for (const EmbeddedScenario& embedded : embedded_scenarios())
    if (embedded.name == name)
      return {std::string(embedded.text), fmt::format("{}.yaml", embedded.name), folder, assets};
  if (of_embedded)
    if (const auto text = embedded_text(name)) return {*text, name, folder, assets};
  fs::path file = folder / name;
  std::error_code ignored;
  if (!fs::is_regular_file(file, ignored) && !assets.empty()) file = assets / name;
  if (!fs::is_regular_file(file, ignored))
    throw_user_error("base: expected an embedded scenario or a file beside the campaign, found no '{}'",
                     name);
  return {InputFile(file, fmt::format("{}: expected a scenario", file.string()), budget::yaml_file).text(),
          file.string(), file.parent_path(), assets};
}

}  // namespace

fs::path OpenCampaign::part(const CampaignUnit& unit) const {
  return folder / "parts" / cells[unit.cell].name / fmt::format("{:04}", unit.sequence);
}
fs::path OpenCampaign::journals(size_t cell) const { return folder / "journals" / cells[cell].name; }
fs::path OpenCampaign::data(size_t cell) const { return folder / "data" / cells[cell].name; }

bool OpenCampaign::merged(size_t cell) const { return is_there(data(cell) / io::manifest_file); }

io::PartState OpenCampaign::state(const CampaignUnit& unit) const {
  if (is_there(io::kept_journal(journals(unit.cell), unit.sequence))) return {true, true, 0};
  return io::part_state(part(unit), unit.sequence);
}

fs::path consistency_of(const fs::path& journals, uint32_t sequence) {
  return journals / fmt::format("{}.csv", io::sequence_folder(sequence));
}

std::vector<CampaignUnit> OpenCampaign::units() const {
  std::vector<CampaignUnit> all;
  for (size_t cell = 0; cell < cells.size(); ++cell)
    for (uint32_t sequence = 0; sequence < sequences(cell); ++sequence) all.push_back({cell, sequence});
  return all;
}

std::string embedded_campaign_names() {
  std::string names;
  for (const EmbeddedScenario& embedded : embedded_campaigns())
    if (is_campaign_text(embedded.text)) names += (names.empty() ? "" : ", ") + std::string(embedded.name);
  return names;
}

bool is_campaign(const std::string& file) {
  std::error_code unreadable;
  if (!fs::is_regular_file(file, unreadable)) {
    const std::optional<std::string> text = embedded_text(file);
    return text && is_campaign_text(*text);
  }
  const InputFile input(file, fmt::format("{}: expected a scenario or a campaign", file), budget::yaml_file);
  return is_campaign_text(input.text());
}

OpenCampaign open_campaign(const CampaignOptions& options) {
  OpenCampaign open;
  const fs::path file = options.file;
  const auto embedded = is_there(file) ? std::nullopt : embedded_text(options.file);
  if (!embedded && !is_there(file)) {
    std::vector<std::string> known;
    for (const EmbeddedScenario& campaign : embedded_campaigns())
      if (is_campaign_text(campaign.text)) known.emplace_back(campaign.name);
    throw_user_error("{}: no such campaign: expected a YAML file or one of {}{}", options.file,
                     fmt::join(known, ", "), suggestion(options.file, known));
  }
  const std::string text =
      embedded ? *embedded
               : InputFile(file, fmt::format("{}: expected a campaign file", options.file), budget::yaml_file)
                     .text();
  if (!is_campaign_text(text) && (text.starts_with("greatx:") || text.find("\ngreatx:") != std::string::npos))
    throw_user_error("{0}: expected a campaign, found a scenario; `greatx generate {0} -o DIR` runs it",
                     options.file);
  open.campaign = sim::parse_campaign(text, options.file, fs::absolute(file).parent_path());
  open.folder = options.output;
  open.cells = sim::campaign_cells(open.campaign, [&](const std::string& name) {
    return base_scenario(name, open.campaign.folder, options.assets, embedded.has_value());
  });
  if (std::ranges::any_of(open.cells, [](const auto& cell) { return !cell.scenario.accuracy.empty(); }))
    spdlog::warn(
        "{}: a campaign takes the settings that are written, and chooses none for 'accuracy' and "
        "'time_budget_ms_per_tick'; `greatx calibrate` writes a scenario with the choice",
        options.file);
  if (options.cells.empty()) return open;
  std::vector<std::string> names;
  for (const sim::CampaignCell& cell : open.cells) names.push_back(cell.name);
  for (const std::string& name : options.cells)
    if (std::ranges::find(names, name) == names.end())
      throw_user_error(
          "--cell: expected one of the cells of {}, found '{}'{}; `greatx campaign plan` lists them",
          options.file, name, suggestion(name, names));
  std::erase_if(open.cells, [&](const sim::CampaignCell& cell) {
    return std::ranges::find(options.cells, cell.name) == options.cells.end();
  });
  return open;
}

nlohmann::json known_cells(const fs::path& folder) {
  const fs::path file = folder / cells_file;
  if (!is_there(file)) return nlohmann::json::object();
  const nlohmann::json known = nlohmann::json::parse(io::read_text_file(file), nullptr, false);
  if (!known.is_object()) throw_user_error("{}: expected a JSON object, found something else", file.string());
  return known;
}

void claim_folder(const OpenCampaign& open) {
  io::create_folders(open.folder);
  const fs::path file = open.folder / cells_file;
  nlohmann::json cells = known_cells(open.folder);
  bool changed = false;
  for (const sim::CampaignCell& cell : open.cells) {
    const std::string identity = identity_of(cell);
    const auto known = cells.find(cell.name);
    if (known != cells.end() && *known != identity)
      throw_user_error(
          "{}: cell '{}' was begun with another scenario; choose another folder (-o), or undo the change of "
          "{} "
          "or of its base scenario. More sequences and new cells are no change",
          open.folder.string(), cell.name, open.campaign.file);
    changed = changed || known == cells.end();
    cells[cell.name] = identity;
  }
  if (changed) write_among_shards(file, json_text(cells));
  write_among_shards(open.folder / "campaign.yaml", open.campaign.text);
}

Shard parse_shard(const std::string& text) {
  const size_t slash = text.find('/');
  const auto number = [&](std::string_view part) {
    uint32_t value = 0;
    const auto [end, error] = std::from_chars(part.data(), part.data() + part.size(), value);
    return error == std::errc() && end == part.data() + part.size() ? value : 0u;
  };
  Shard shard{0, 0};
  if (slash != std::string::npos)
    shard = {number(std::string_view(text).substr(0, slash)),
             number(std::string_view(text).substr(slash + 1))};
  if (shard.index < 1 || shard.index > shard.count)
    throw_user_error("--shard: expected I/N with 1 <= I <= N, such as 2/8, found '{}'", text);
  return shard;
}

std::span<const CampaignUnit> units_of(std::span<const CampaignUnit> units, const Shard& shard) {
  const size_t first = units.size() * (shard.index - 1) / shard.count;
  return units.subspan(first, units.size() * shard.index / shard.count - first);
}

}  // namespace greatx::apps
