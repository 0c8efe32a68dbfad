// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// The scenario that the viewer shows, as a text that can be changed, undone and saved. The text is the only
// truth: every change is made in it, and the parser of `greatx generate` reads the result. A change that the
// parser refuses leaves everything as it was.
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "core/fields/edit_yaml.h"
#include "sim/scenario/scenario.h"

namespace greatx::view {

class ScenarioDocument {
 public:
  /// Parses a text that stands for the file of `first`. Throws UserError with file and line.
  using Parse = std::function<sim::Scenario(const std::string& text)>;
  /// Begins with the text of `first`.
  ScenarioDocument(const sim::Scenario& first, Parse parse);
  ~ScenarioDocument();
  ScenarioDocument(const ScenarioDocument&) = delete;
  ScenarioDocument& operator=(const ScenarioDocument&) = delete;

  const std::string& text() const { return states_[at_].text; }
  const std::shared_ptr<const FieldValue>& values() const { return states_[at_].values; }
  const sim::Scenario& scenario() const { return states_[at_].scenario; }
  /// The radio materials that the scenario gives its scene (docs/materials.md): of its file, or none.
  const std::shared_ptr<const FieldValue>& materials() const { return states_[at_].material_values; }
  /// What the last change was, for a menu: "sun.elevation_deg"; empty at the first state.
  const std::string& label() const { return states_[at_].label; }
  /// Counts the changes, undone ones too.
  uint64_t version() const { return version_; }

  /// Changes one value. Returns false if comments were lost. Throws UserError, and changes nothing, if the
  /// place is not there or the parser refuses the result.
  bool change(const YamlChange& change);
  /// Makes several changes as one step.
  bool change(const std::vector<YamlChange>& changes, const std::string& label);
  /// Changes the radio materials, whose path begins with "materials". It is saved with the scenario.
  void change_materials(const std::vector<YamlChange>& changes);
  /// Replaces the whole text.
  void replace(const std::string& text);
  bool can_undo() const { return at_ > 0; }
  bool can_redo() const { return at_ + 1 < states_.size(); }
  void undo();
  void redo();

  /// Whether the text, or the radio materials, differ from their files.
  bool is_changed() const { return text() != saved_ || states_[at_].materials != saved_materials_; }
  /// Writes the text to a file, at once or not at all. In another folder, files that the scenario names
  /// relative to its own folder get their whole path. The document is that file from now on. Changed radio
  /// materials are written first: to their file, or to NAME_materials.yaml beside the scenario, which then
  /// names it.
  void save(const std::filesystem::path& file);
  /// Where save() would write by default: the scenario's own file, or NAME.yaml of an embedded one.
  std::filesystem::path file() const;

 private:
  struct State {
    std::string text, materials, label;
    std::shared_ptr<const FieldValue> values, material_values;
    sim::Scenario scenario;
  };
  State state_of(std::string text, std::string materials, std::string label);
  std::filesystem::path unsaved_materials(const std::string& text);
  void push(State state);

  static constexpr size_t most_states = 200;  ///< that can be undone
  Parse parse_;
  std::filesystem::path file_;  ///< empty: embedded
  std::vector<State> states_;
  size_t at_ = 0;
  uint64_t version_ = 0;
  std::string saved_, saved_materials_;
  std::filesystem::path scratch_;  ///< folder of materials that are not saved; empty: none was needed
  int scratch_files_ = 0;
};

}  // namespace greatx::view
