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

  const std::string& text() const { return states_[at_].text; }
  const std::shared_ptr<const FieldValue>& values() const { return states_[at_].values; }
  const sim::Scenario& scenario() const { return states_[at_].scenario; }
  /// What the last change was, for a menu: "sun.elevation_deg"; empty at the first state.
  const std::string& label() const { return states_[at_].label; }
  /// Counts the changes, undone ones too.
  uint64_t version() const { return version_; }

  /// Changes one value. Returns false if comments were lost. Throws UserError, and changes nothing, if the
  /// place is not there or the parser refuses the result.
  bool change(const YamlChange& change);
  /// Makes several changes as one step.
  bool change(const std::vector<YamlChange>& changes, const std::string& label);
  /// Replaces the whole text.
  void replace(const std::string& text);
  bool can_undo() const { return at_ > 0; }
  bool can_redo() const { return at_ + 1 < states_.size(); }
  void undo();
  void redo();

  /// Whether the text differs from the file.
  bool is_changed() const { return text() != saved_; }
  /// Writes the text to a file, at once or not at all. In another folder, files that the scenario names
  /// relative to its own folder get their whole path. The document is that file from now on.
  void save(const std::filesystem::path& file);
  /// Where save() would write by default: the scenario's own file, or NAME.yaml of an embedded one.
  std::filesystem::path file() const;

 private:
  struct State {
    std::string text, label;
    std::shared_ptr<const FieldValue> values;
    sim::Scenario scenario;
  };
  State state_of(std::string text, std::string label) const;
  void push(State state);

  static constexpr size_t most_states = 200;  ///< that can be undone
  Parse parse_;
  std::filesystem::path file_;  ///< empty: embedded
  std::vector<State> states_;
  size_t at_ = 0;
  uint64_t version_ = 0;
  std::string saved_;
};

}  // namespace greatx::view
