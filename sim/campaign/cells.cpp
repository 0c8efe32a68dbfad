// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "sim/campaign/cells.h"

#include <algorithm>
#include <map>

#include <fmt/format.h>

#include "core/fields/named_path.h"
#include "sim/scenario/parse/load_scenario.h"
#include "sim/scenario/parse/override.h"

namespace greatx::sim {
namespace {

constexpr size_t most_cells = 100'000;

bool excluded(const CampaignExclusion& exclusion, const std::vector<size_t>& values) {
  return std::ranges::all_of(exclusion.values, [&](const auto& entry) {
    return std::ranges::find(entry.second, values[entry.first]) != entry.second.end();
  });
}

std::string name_of(const Campaign& campaign, const std::vector<size_t>& values) {
  std::string name;
  for (size_t a = 0; a < values.size(); ++a)
    name += fmt::format("{}{}", a > 0 ? "." : "", campaign.axes[a].values[values[a]].name);
  return name.empty() ? "all" : name;
}

std::string where_text(const Campaign& campaign, const SourceLocation& where) {
  return where.line > 0 ? fmt::format("{}:{}", campaign.file, where.line) : campaign.file;
}

/// Makes the scenario of a cell. The base texts are read once each.
class CellMaker {
 public:
  CellMaker(const Campaign& campaign, const FindBase& find_base)
      : campaign_(campaign), find_base_(find_base) {}

  CampaignCell make(const std::vector<size_t>& values) {
    CampaignCell cell{name_of(campaign_, values), values, {}};
    const BaseScenario& base = base_of(values);
    std::string text = base.text;
    const auto apply = [&](const std::vector<CampaignChange>& changes) {
      for (const CampaignChange& change : changes)
        text = set_yaml_value(text, change.path, change.value, where_text(campaign_, change.where));
    };
    apply(campaign_.changes);
    uint32_t sequences = campaign_.sequences;
    for (size_t a = 0; a < values.size(); ++a) {
      const CampaignValue& value = campaign_.axes[a].values[values[a]];
      apply(value.changes);
      sequences = value.sequences.value_or(sequences);
    }
    text = set_yaml_value(text, "name", cell.name, campaign_.file);
    text = set_yaml_value(text, "sequences", fmt::format("{}", sequences), campaign_.file);
    cell.scenario =
        parse_scenario(text, fmt::format("{}: cell {} ({})", campaign_.file, cell.name, base.name),
                       base.folder, base.assets);
    return cell;
  }

 private:
  const BaseScenario& base_of(const std::vector<size_t>& values) {
    const std::string* name = &campaign_.base;
    for (size_t a = 0; a < values.size(); ++a) {
      const std::string& base = campaign_.axes[a].values[values[a]].base;
      if (!base.empty()) name = &base;
    }
    const auto [at, is_new] = bases_.try_emplace(*name);
    if (is_new) at->second = find_base_(*name);
    return at->second;
  }

  const Campaign& campaign_;
  const FindBase& find_base_;
  std::map<std::string, BaseScenario> bases_;
};

/// Moves to the next choice of values, the last axis running fastest. Returns false after the last one.
bool advance(const Campaign& campaign, std::vector<size_t>& values) {
  for (size_t a = values.size(); a-- > 0;) {
    if (++values[a] < campaign.axes[a].values.size()) return true;
    values[a] = 0;
  }
  return false;
}

}  // namespace

std::vector<CampaignCell> campaign_cells(const Campaign& campaign, const FindBase& find_base) {
  std::vector<CampaignCell> cells;
  std::vector<bool> used(campaign.exclusions.size());
  CellMaker maker(campaign, find_base);
  std::vector<size_t> values(campaign.axes.size(), 0);
  do {
    bool out = false;
    for (size_t e = 0; e < campaign.exclusions.size(); ++e)
      if (excluded(campaign.exclusions[e], values)) out = used[e] = true;
    if (out) continue;
    if (cells.size() == most_cells)
      throw_user_error("{}: axes: expected at most {} cells, found more", campaign.file, most_cells);
    cells.push_back(maker.make(values));
  } while (advance(campaign, values));
  for (size_t e = 0; e < used.size(); ++e)
    if (!used[e])
      throw_user_error("{}: exclude[{}]: expected values of a cell, found none that other exclusions leave",
                       where_text(campaign, campaign.exclusions[e].where), e);
  if (cells.empty()) throw_user_error("{}: exclude: nothing is left", campaign.file);
  return cells;
}

Scenario with_sequences(const Scenario& scenario, uint32_t count) {
  Scenario changed = scenario;
  override_scenario(changed, {.sequences = count});
  return changed;
}

}  // namespace greatx::sim
