// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "view/edit/document.h"

#include <algorithm>
#include <array>
#include <cstdlib>
#include <system_error>
#include <utility>

#include <fmt/format.h>

#include "core/budget.h"
#include "core/error.h"
#include "core/fields/yaml.h"
#include "core/input_file.h"
#include "io/files/file.h"

namespace greatx::view {

namespace {

/// The keys whose values are files.
constexpr std::array file_keys{"file", "radio_materials", "csv", "gpx", "shots_file", "pattern_file"};

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

/// Returns the text of the scenario's radio materials.
std::string materials_of(const sim::Scenario& scenario) {
  if (scenario.scene.radio_materials.empty()) return "materials: {}\n";
  return InputFile(scenario.scene.radio_materials, "expected readable radio materials", budget::yaml_file)
      .text();
}

}  // namespace

ScenarioDocument::ScenarioDocument(const sim::Scenario& first, Parse parse)
    : parse_(std::move(parse)), file_(first.file), saved_(first.text), saved_materials_(materials_of(first)) {
  states_.push_back({first.text, saved_materials_, "", read_yaml(first.text, first.name),
                     read_yaml(saved_materials_, first.scene.radio_materials.string()), first});
}

ScenarioDocument::~ScenarioDocument() {
  std::error_code error;
  if (!scratch_.empty()) std::filesystem::remove_all(scratch_, error);
}

/// Writes radio materials to a file of their own, which a run reads instead of the saved ones.
std::filesystem::path ScenarioDocument::unsaved_materials(const std::string& text) {
  if (scratch_.empty()) {
    std::string folder = (std::filesystem::temp_directory_path() / "greatx-view-XXXXXX").string();
    if (mkdtemp(folder.data()) == nullptr) throw_user_error("{}: cannot make the folder", folder);
    scratch_ = folder;
  }
  const std::filesystem::path file = scratch_ / fmt::format("materials_{}.yaml", ++scratch_files_);
  io::write_file_atomically(file, text);
  return file;
}

ScenarioDocument::State ScenarioDocument::state_of(std::string text, std::string materials,
                                                   std::string label) {
  State state;
  state.scenario = parse_(text);
  state.values = read_yaml(text, state.scenario.name);
  state.material_values = read_yaml(materials, "the radio materials");
  if (materials == states_[at_].materials && states_[at_].materials != saved_materials_)
    state.scenario.scene.radio_materials = states_[at_].scenario.scene.radio_materials;
  else if (materials != saved_materials_)
    state.scenario.scene.radio_materials = unsaved_materials(materials);
  state.text = std::move(text);
  state.materials = std::move(materials);
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
  if (edited.text != text()) push(state_of(std::move(edited.text), states_[at_].materials, label));
  return kept;
}

void ScenarioDocument::change_materials(const std::vector<YamlChange>& changes) {
  std::string edited = states_[at_].materials;
  for (const YamlChange& change : changes) edited = edit_yaml(edited, change).text;
  if (edited != states_[at_].materials)
    push(state_of(text(), std::move(edited), yaml_path_text(changes.front().path)));
}

void ScenarioDocument::replace(const std::string& text) {
  if (text != this->text()) push(state_of(text, states_[at_].materials, "text"));
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
  const std::string materials = states_[at_].materials;
  io::create_folder_of(place);
  if (materials != saved_materials_) {
    const auto named = value_at(values(), {YamlStep("scene"), YamlStep("radio_materials")});
    const std::filesystem::path own = named != nullptr
                                          ? parse_(text()).scene.radio_materials
                                          : place.parent_path() / (scenario().name + "_materials.yaml");
    io::write_file_atomically(own, materials);
    if (named == nullptr)
      written = edit_yaml(written, {YamlChange::Kind::set,
                                    {YamlStep("scene"), YamlStep("radio_materials")},
                                    yaml_text(own.string())})
                    .text;
    saved_materials_ = materials;
  }
  io::write_file_atomically(place, written);
  if (written != text()) push(state_of(written, materials, "save"));
  file_ = place;
  saved_ = written;
}

}  // namespace greatx::view
