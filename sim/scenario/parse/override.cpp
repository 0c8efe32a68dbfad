// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "sim/scenario/parse/override.h"

#include <algorithm>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <yaml-cpp/yaml.h>

namespace greatx::sim {
namespace {

/// Describes a key of the scenario's top level that gets a value. The key `instead_of` gives way to it, if it
/// is there.
struct NewValue {
  std::string key, value, instead_of;
};

struct Edit {
  size_t at = 0, length = 0;
  std::string text;
};

/// Returns the place of a node in the text by yaml-cpp's mark. The result is empty if an anchor, an alias or
/// quotes stand there instead.
std::optional<size_t> place_of(const std::string& text, const YAML::Node& node) {
  const YAML::Mark mark = node.Mark();
  if (mark.is_null() || mark.pos < 0) return std::nullopt;
  const auto at = static_cast<size_t>(mark.pos);
  const std::string& what = node.Scalar();
  if (what.empty() || at > text.size() || text.compare(at, what.size(), what) != 0) return std::nullopt;
  return at;
}

/// Replaces or inserts one value. Returns false if the text does not allow that.
bool plan_edit(const std::string& text, const YAML::Node& root, const NewValue& value,
               std::vector<Edit>& edits) {
  for (const auto& entry : root) {
    const std::string& key = entry.first.Scalar();
    if (key != value.key && (value.instead_of.empty() || key != value.instead_of)) continue;
    const auto key_at = place_of(text, entry.first), value_at = place_of(text, entry.second);
    if (!key_at || !value_at) return false;
    edits.push_back({*value_at, entry.second.Scalar().size(), value.value});
    if (key != value.key) edits.push_back({*key_at, key.size(), value.key});
    return true;
  }
  // The value goes before the second key (the first is most often the format's version), where a comment
  // above it may stay.
  auto before = root.begin();
  if (root.size() > 1) ++before;
  const auto at = place_of(text, before->first);
  if (!at) return false;
  const size_t line = text.rfind('\n', *at) + 1;  // npos + 1 is the text's begin
  const std::string indent = text.substr(line, *at - line);
  if (root.Style() == YAML::EmitterStyle::Flow) {
    edits.push_back({*at, 0, fmt::format("{}: {}, ", value.key, value.value)});
    return true;
  }
  if (indent.find_first_not_of(' ') != std::string::npos) return false;
  edits.push_back({line, 0, fmt::format("{}{}: {}\n", indent, value.key, value.value)});
  return true;
}

bool says(const std::string& text, const std::vector<NewValue>& values) {
  try {
    const YAML::Node root = YAML::Load(text);
    return std::all_of(values.begin(), values.end(), [&](const NewValue& value) {
      return root[value.key] && root[value.key].IsScalar() && root[value.key].Scalar() == value.value &&
             (value.instead_of.empty() || !root[value.instead_of]);
    });
  } catch (const YAML::Exception&) {
    return false;
  }
}

/// Handles the cases that text edits cannot (anchors, quotes). It returns the same document as yaml-cpp
/// writes it, without its comments.
std::string rewritten(const YAML::Node& document, const std::vector<NewValue>& values) {
  YAML::Node root = YAML::Clone(document);
  for (const NewValue& value : values) {
    // The key is removed first, since an assignment would go to all aliases of the old value.
    root.remove(value.key);
    if (!value.instead_of.empty()) root.remove(value.instead_of);
    root.force_insert(value.key, value.value);
  }
  YAML::Emitter out;
  out << root;
  return std::string(out.c_str()) + "\n";
}

std::string text_with(const std::string& text, const std::vector<NewValue>& values) {
  const YAML::Node root = YAML::Load(text);
  std::vector<Edit> edits;
  const bool planned = std::all_of(values.begin(), values.end(), [&](const NewValue& value) {
    return plan_edit(text, root, value, edits);
  });
  std::string edited = text;
  // The edits go from the back, so that places hold. Edits of one place end up in the order given.
  std::stable_sort(edits.begin(), edits.end(), [](const Edit& a, const Edit& b) { return a.at < b.at; });
  for (auto edit = edits.rbegin(); edit != edits.rend(); ++edit)
    edited.replace(edit->at, edit->length, edit->text);
  if (!planned || !says(edited, values)) edited = rewritten(root, values);
  GREATX_CHECK(says(edited, values), "no way to write {} values into the scenario", values.size());
  return edited;
}

bool has_curves(const Scenario& scenario) {
  return std::any_of(scenario.nodes.begin(), scenario.nodes.end(), [](const NodeConfig& node) {
    return std::holds_alternative<BezierTrajectory>(node.trajectory) ||
           std::holds_alternative<CorridorTrajectory>(node.trajectory);
  });
}

}  // namespace

void override_ticks(Scenario& scenario, int64_t ticks) {
  if (ticks != scenario.ticks && has_curves(scenario)) scenario.trajectory_ticks = scenario.curve_ticks();
  scenario.ticks = ticks;
}

void override_scenario(Scenario& scenario, const ScenarioOverrides& overrides) {
  std::vector<NewValue> values;
  if (overrides.seed && *overrides.seed != scenario.seed) {
    scenario.seed = *overrides.seed;
    values.push_back({"seed", fmt::format("{}", scenario.seed), ""});
  }
  if (overrides.sequences && *overrides.sequences != scenario.sequences) {
    scenario.sequences = *overrides.sequences;
    values.push_back({"sequences", fmt::format("{}", scenario.sequences), ""});
  }
  if (overrides.ticks && *overrides.ticks != scenario.ticks) {
    const std::optional<int64_t> before = scenario.trajectory_ticks;
    override_ticks(scenario, *overrides.ticks);
    values.push_back({"ticks", fmt::format("{}", scenario.ticks), "duration_s"});
    if (scenario.trajectory_ticks != before)
      values.push_back({"trajectory_ticks", fmt::format("{}", *scenario.trajectory_ticks), ""});
  }
  if (!values.empty()) scenario.text = text_with(scenario.text, values);
}

}  // namespace greatx::sim
