// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "view/edit/document.h"

#include <algorithm>
#include <array>
#include <system_error>
#include <utility>

#include "core/error.h"
#include "core/fields/yaml.h"
#include "io/files/file.h"

namespace greatx::view {

namespace {

/// The keys whose values are files.
constexpr std::array file_keys{"file", "radio_materials", "csv", "shots_file", "pattern_file"};

/// Lists the places of files that are given relative to the scenario's folder and lie there.
void find_files(const FieldValue& value, const YamlPath& here, const std::filesystem::path& folder,
                std::vector<YamlChange>& changes) {
  const auto step = [&](YamlStep last) {
    YamlPath path = here;
    path.push_back(std::move(last));
    return path;
  };
  for (size_t i = 0; i < value.items.size(); ++i) find_files(*value.items[i], step(i), folder, changes);
  for (const FieldValue::Member& member : value.members) {
    const std::filesystem::path named = member.value->text;
    std::error_code error;
    if (std::ranges::find(file_keys, member.key) != file_keys.end() && !named.empty() &&
        named.is_relative() && std::filesystem::exists(folder / named, error))
      changes.push_back(
          {YamlChange::Kind::set, step(member.key), yaml_text((folder / named).lexically_normal().string())});
    find_files(*member.value, step(member.key), folder, changes);
  }
}

}  // namespace

ScenarioDocument::ScenarioDocument(const sim::Scenario& first, Parse parse)
    : parse_(std::move(parse)), file_(first.file), saved_(first.text) {
  states_.push_back({first.text, "", read_yaml(first.text, first.name), first});
}

ScenarioDocument::State ScenarioDocument::state_of(std::string text, std::string label) const {
  State state;
  state.scenario = parse_(text);
  state.values = read_yaml(text, state.scenario.name);
  state.text = std::move(text);
  state.label = std::move(label);
  return state;
}

void ScenarioDocument::push(State state) {
  states_.resize(at_ + 1);
  states_.push_back(std::move(state));
  if (states_.size() > most_states) states_.erase(states_.begin());
  at_ = states_.size() - 1;
  ++version_;
}

bool ScenarioDocument::change(const YamlChange& change) {
  return this->change(std::vector{change}, yaml_path_text(change.path));
}

bool ScenarioDocument::change(const std::vector<YamlChange>& changes, const std::string& label) {
  EditedYaml edited{text(), true};
  bool kept = true;
  for (const YamlChange& change : changes) {
    edited = edit_yaml(edited.text, change);
    kept = kept && edited.kept_comments;
  }
  if (edited.text != text()) push(state_of(std::move(edited.text), label));
  return kept;
}

void ScenarioDocument::replace(const std::string& text) {
  if (text != this->text()) push(state_of(text, "text"));
}

void ScenarioDocument::undo() {
  if (!can_undo()) return;
  --at_;
  ++version_;
}
void ScenarioDocument::redo() {
  if (!can_redo()) return;
  ++at_;
  ++version_;
}

std::filesystem::path ScenarioDocument::file() const {
  return file_.empty() ? std::filesystem::path(scenario().name + ".yaml") : file_;
}

void ScenarioDocument::save(const std::filesystem::path& file) {
  const std::filesystem::path place = std::filesystem::absolute(file).lexically_normal();
  std::string written = text();
  if (!file_.empty() && place.parent_path() != file_.parent_path()) {
    std::vector<YamlChange> changes;
    find_files(*values(), {}, file_.parent_path(), changes);
    for (const YamlChange& change : changes) written = edit_yaml(written, change).text;
  }
  io::create_folder_of(place);
  io::write_file_atomically(place, written);
  if (written != text()) push(state_of(written, "save"));
  file_ = place;
  saved_ = written;
}

}  // namespace greatx::view
