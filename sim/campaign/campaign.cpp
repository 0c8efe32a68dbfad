// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "sim/campaign/campaign.h"

#include <algorithm>
#include <set>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "core/fields/edit_yaml.h"
#include "core/fields/field.h"
#include "core/fields/yaml.h"
#include "core/text.h"
#include "sim/scenario/limits.h"

namespace greatx::sim {
namespace {

constexpr size_t most_axes = 32, most_values = 10'000;

std::vector<CampaignChange> parse_changes(const Field& field, std::initializer_list<std::string_view> apart) {
  std::vector<CampaignChange> changes;
  for (const auto& [path, value] : field.entries()) {
    if (std::ranges::find(apart, path) != apart.end()) continue;
    parse_yaml_path(std::string(path).substr(0, path.find('[')));  // the rest is checked with the scenario
    changes.push_back({path, yaml_line(value.value()), value.where()});
  }
  return changes;
}

CampaignValue parse_value(const std::string& name, const Field& field) {
  CampaignValue value{name, "", {}, {}, field.where()};
  if (!field.is_map()) field.fail("a map from places of the scenario to values, e.g. {seed: 3}");
  for (const auto& [key, entry] : field.entries()) {
    if (key == "base") value.base = entry.text();
    if (key == "sequences") value.sequences = entry.integer32(1, most_sequences);
  }
  value.changes = parse_changes(field, {"base", "sequences"});
  return value;
}

std::vector<CampaignAxis> parse_axes(const Field& field) {
  std::vector<CampaignAxis> axes;
  for (const auto& [name, entry] : field.entries()) {
    CampaignAxis axis{name, {}};
    if (!entry.is_map()) entry.fail("a map from names of values to changes of the scenario");
    for (const auto& [value, changes] : entry.entries()) axis.values.push_back(parse_value(value, changes));
    if (axis.values.empty() || axis.values.size() > most_values)
      entry.fail(fmt::format("1 to {} values", most_values), fmt::format("{}", axis.values.size()));
    axes.push_back(std::move(axis));
  }
  if (axes.size() > most_axes) field.fail(fmt::format("at most {} axes", most_axes));
  return axes;
}

/// Checks that names may be parts of a folder's name.
void check_names(const Field& field) {
  for (const auto& [name, entry] : field.entries()) {
    const auto good = [](std::string_view text) {
      return !text.empty() && text.size() <= 64 && std::ranges::all_of(text, [](char c) {
        return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '_' ||
               c == '-';
      });
    };
    if (!good(name))
      entry.refuse(fmt::format("expected a name of letters, digits, _ and -, found '{}'", name));
    if (!entry.is_map()) continue;
    for (const auto& [value, changes] : entry.entries())
      if (!good(value))
        changes.refuse(fmt::format("expected a name of letters, digits, _ and -, found '{}'", value));
  }
}

size_t find_axis(const std::vector<CampaignAxis>& axes, const std::string& name, const Field& field) {
  const auto at = std::ranges::find(axes, name, &CampaignAxis::name);
  if (at != axes.end()) return static_cast<size_t>(at - axes.begin());
  std::vector<std::string> names;
  for (const CampaignAxis& axis : axes) names.push_back(axis.name);
  field.refuse(fmt::format("expected one of the axes {}, found '{}'{}", fmt::join(names, ", "), name,
                           suggestion(name, names)));
}

size_t find_value(const CampaignAxis& axis, const Field& field) {
  const std::string name = field.text();
  const auto at = std::ranges::find(axis.values, name, &CampaignValue::name);
  if (at != axis.values.end()) return static_cast<size_t>(at - axis.values.begin());
  std::vector<std::string> names;
  for (const CampaignValue& value : axis.values) names.push_back(value.name);
  field.fail(fmt::format("one of the values of '{}': {}", axis.name, fmt::join(names, ", ")),
             fmt::format("'{}'{}", name, suggestion(name, names)));
}

std::vector<size_t> find_values(const CampaignAxis& axis, const Field& field) {
  if (!field.is_list()) return {find_value(axis, field)};
  std::vector<size_t> values;
  for (const Field& item : field.list("values", 1)) values.push_back(find_value(axis, item));
  return values;
}

std::vector<CampaignExclusion> parse_exclusions(const Field& field, const std::vector<CampaignAxis>& axes) {
  std::vector<CampaignExclusion> exclusions;
  for (const Field& item : field.list("exclusions")) {
    CampaignExclusion exclusion{{}, item.where()};
    for (const auto& [name, values] : item.entries()) {
      const size_t axis = find_axis(axes, name, values);
      exclusion.values.emplace_back(axis, find_values(axes[axis], values));
    }
    if (exclusion.values.empty()) item.fail("one axis or more");
    exclusions.push_back(std::move(exclusion));
  }
  return exclusions;
}

/// Whether records of two values of an axis never share a place: the values choose other scenes, or draw
/// other trajectories.
bool parts_places(const CampaignAxis& axis) {
  return std::ranges::all_of(axis.values, [](const CampaignValue& value) {
    return !value.base.empty() || std::ranges::any_of(value.changes, [](const CampaignChange& change) {
      return change.path == "seed" || change.path == "scene" || change.path.starts_with("scene.");
    });
  });
}

CampaignSplit parse_split(const Field& field, const std::vector<CampaignAxis>& axes) {
  const FieldMap map(field, {"by", "train", "validation", "test"});
  CampaignSplit split;
  const auto by = map.find("by");
  if (!by || by->text() == "trajectory") {
    const auto share = [&](const char* name) {
      const auto f = map.find(name);
      return f ? f->between(0.0, 1.0) : 0.0;
    };
    split.train = share("train"), split.validation = share("validation");
    if (std::abs(split.train + split.validation + share("test") - 1.0) > 1e-9)
      field.fail("shares of train, validation and test that sum to 1",
                 fmt::format("{:g}", split.train + split.validation + share("test")));
    return split;
  }
  split.axis = find_axis(axes, by->text(), *by);
  const CampaignAxis& axis = axes[*split.axis];
  if (!parts_places(axis))
    by->refuse(fmt::format(
        "expected 'trajectory' or an axis each value of which changes the scene, the base or the seed; "
        "values of '{}' share places and trajectories, so that records of one place would be in "
        "two splits",
        axis.name));
  std::vector<std::optional<Split>> of_value(axis.values.size());
  for (size_t s = 0; s < std::size(split_names); ++s) {
    const auto f = map.find(split_names[s]);
    if (!f) continue;
    for (const size_t value : find_values(axis, *f)) {
      if (of_value[value])
        f->refuse(fmt::format("'{}' is in {} already", axis.values[value].name,
                              split_names[static_cast<size_t>(*of_value[value])]));
      of_value[value] = static_cast<Split>(s);
    }
  }
  for (size_t v = 0; v < of_value.size(); ++v) {
    if (!of_value[v])
      field.refuse(fmt::format("expected each value of '{}' in train, validation or test; '{}' is in none",
                               axis.name, axis.values[v].name));
    split.of_value.push_back(*of_value[v]);
  }
  return split;
}

CampaignCard parse_card(const Field& field) {
  const FieldMap map(field, {"description", "license", "citation", "creators"});
  CampaignCard card;
  if (const auto f = map.find("description")) card.description = f->text();
  if (const auto f = map.find("license")) card.license = f->text();
  if (const auto f = map.find("citation")) card.citation = f->text();
  if (const auto f = map.find("creators"))
    for (const Field& creator : f->list("creators", 1)) card.creators.push_back(creator.text());
  return card;
}

/// Returns the fraction of number times the golden section: numbers that follow one another fill 0 to 1
/// evenly, however many they are (H. Weyl's sequence).
double golden_place(uint32_t number) { return number * 2654435769u * 0x1.0p-32; }

}  // namespace

Campaign parse_campaign(const std::string& text, const std::string& file,
                        const std::filesystem::path& folder) {
  const Field root = Field::parse_yaml(text, {file, folder, {}});
  const FieldMap map(root, {"greatx_campaign", "name", "base", "set", "axes", "exclude", "sequences", "split",
                            "budget", "card"});
  map.require("greatx_campaign", "1 (the format's version)").choice({"1"});
  Campaign campaign;
  campaign.text = text, campaign.file = file, campaign.folder = folder;
  campaign.name = map.require("name", "a name").name();
  campaign.base = map.require("base", "a scenario").text();
  if (const auto f = map.find("set")) campaign.changes = parse_changes(*f, {});
  if (const auto f = map.find("axes")) {
    check_names(*f);
    campaign.axes = parse_axes(*f);
  }
  if (const auto f = map.find("sequences")) campaign.sequences = f->integer32(1, most_sequences);
  if (const auto f = map.find("exclude")) campaign.exclusions = parse_exclusions(*f, campaign.axes);
  if (const auto f = map.find("split")) campaign.split = parse_split(*f, campaign.axes);
  if (const auto f = map.find("card")) campaign.card = parse_card(*f);
  if (const auto f = map.find("budget")) {
    const FieldMap budget(*f, {"hours", "gigabytes"});
    if (const auto hours = budget.find("hours")) campaign.most_hours = hours->positive(1e-6, 1e9);
    if (const auto size = budget.find("gigabytes")) campaign.most_gigabytes = size->positive(1e-6, 1e12);
  }
  return campaign;
}

Split split_of(const Campaign& campaign, const std::vector<size_t>& values, uint32_t sequence) {
  const CampaignSplit& split = campaign.split;
  if (split.axis) return split.of_value.at(values.at(*split.axis));
  const double place = golden_place(sequence);
  if (place < split.train) return Split::train;
  return place < split.train + split.validation ? Split::validation : Split::test;
}

}  // namespace greatx::sim
