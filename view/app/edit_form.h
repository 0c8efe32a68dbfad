// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// A form of a YAML document, made from its schema: a widget for each value, with its bounds and default.
#pragma once

#include <map>
#include <string>
#include <vector>

#include "core/fields/edit_yaml.h"
#include "view/edit/schema.h"

namespace greatx::view {

class EditForm {
 public:
  /// `schema` outlives the form.
  explicit EditForm(const Schema& schema) : schema_(schema) {}

  /// Draws the value at `path` with all that is below it. Returns what the user has changed in this frame.
  std::vector<YamlChange> draw(const std::shared_ptr<const FieldValue>& root, const YamlPath& path);
  /// Draws the members of the whole document whose place contains `words`, each on a line.
  std::vector<YamlChange> draw_found(const std::shared_ptr<const FieldValue>& root, const std::string& words);
  /// Whether the map at `path` can have members of these names.
  bool has_members(const std::shared_ptr<const FieldValue>& root, const YamlPath& path,
                   const std::vector<std::string>& keys) const;
  /// Draws the members of these names of the map at `path`, given or not.
  std::vector<YamlChange> draw_members(const std::shared_ptr<const FieldValue>& root, const YamlPath& path,
                                       const std::vector<std::string>& keys);

 private:
  void member(const std::string& label, const SchemaPart& part, const FieldValue* value, const YamlPath& path,
              bool removable);
  void map(const FormType& type, const FieldValue& value, const YamlPath& path);
  void absent_members(const FormType& type, const FieldValue& value, const YamlPath& path);
  void list(const FormType& type, const FieldValue& value, const YamlPath& path);
  void shape(const FormType& type, const FieldValue& value, const YamlPath& path);
  void scalar(const FormType& type, const FieldValue& value, const YamlPath& path);
  void number(const FormType& type, const FieldValue& value, const YamlPath& path);
  void numbers(const FormType& type, const FieldValue& value, const YamlPath& path);
  void choices(const FormType& type, const FieldValue& value, const YamlPath& path);
  /// A line of text; `now` is its value when nobody edits it. Changes are YAML, or a text if `is_text`.
  void line(const std::string& now, const YamlPath& path, bool is_text, const char* hint = "");
  void found(const SchemaPart& part, const FieldValue* value, const YamlPath& path, const std::string& words);
  void set(const YamlPath& path, std::string value) {
    changes_.push_back({YamlChange::Kind::set, path, std::move(value)});
  }
  SchemaPart part_at(const FieldValue& root, const YamlPath& path) const;

  const Schema& schema_;
  std::shared_ptr<const FieldValue> root_;  ///< that is drawn
  std::vector<YamlChange> changes_;
  // What the user is editing, until it is done. By path.
  std::map<std::string, std::string> texts_;
  std::map<std::string, std::vector<double>> numbers_;
};

/// Returns a number as short as it can be read again.
std::string number_text(double value);

}  // namespace greatx::view
