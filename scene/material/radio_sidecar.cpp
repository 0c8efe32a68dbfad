// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "scene/material/radio_sidecar.h"

#include <fnmatch.h>
#include <set>

#include "core/input_file.h"
#include "core/yaml/yaml.h"

namespace greatx::scene {
namespace {

using Kind = RadioField::Kind;

constexpr int max_depth = 16;

void set_scalar(RadioField& field, const YAML::Node& node) {
  field.text = node.Scalar();
  field.kind = Kind::text;
  if (const std::optional<bool> boolean = plain_boolean(node)) {
    field.kind = Kind::boolean;
    field.boolean = *boolean;
  } else if (const std::optional<double> number = plain_number(node)) {
    field.kind = Kind::number;
    field.number = *number;
  }
}

RadioField field_from_yaml(const YAML::Node& node, const std::string& file, const std::string& path,
                           int depth) {
  RadioField field;
  field.where = {file, line_of(node)};
  field.path = path;
  if (depth > max_depth) throw_user_error_at(field.where, "{}: nested deeper than {}", path, max_depth);
  if (node.IsScalar()) {
    set_scalar(field, node);
  } else if (node.IsSequence()) {
    field.kind = Kind::list;
    for (size_t index = 0; index < node.size(); ++index) {
      field.items.push_back(
          field_from_yaml(node[index], file, fmt::format("{}[{}]", path, index), depth + 1));
    }
  } else if (node.IsMap()) {
    field.kind = Kind::map;
    for (const auto& member : node) {
      if (!member.first.IsScalar()) {
        throw_user_error_at({file, line_of(member.first)}, "{}: expected a plain key", path);
      }
      const std::string key = member.first.Scalar();
      RadioField value =
          field_from_yaml(member.second, file, path.empty() ? key : path + "." + key, depth + 1);
      value.where = {file, line_of(member.first)};
      field.members.emplace_back(key, std::move(value));
    }
  }
  return field;
}

YAML::Node parse_yaml(const std::filesystem::path& file) {
  const std::string name = file.string();
  const std::string text = InputFile(file, "radio materials", budget::yaml_file).text();
  try {
    const std::vector<YAML::Node> documents = load_yaml(text, name);
    return documents.empty() ? YAML::Node() : documents[0];
  } catch (const YAML::Exception& error) {
    throw_user_error_at({name, line_of(error)}, "not valid YAML: {}", error.msg);
  }
}

}  // namespace

RadioSidecar RadioSidecar::read(const std::filesystem::path& file) {
  const std::string name = file.string();
  const RadioField root = field_from_yaml(parse_yaml(file), name, "", 0);
  if (root.kind != Kind::map) throw_user_error_at({name, 1}, "expected a map with the key 'materials'");
  RadioSidecar sidecar;
  bool found = false;
  for (const auto& [key, value] : root.members) {
    if (key != "materials" || found) {
      throw_user_error_at(value.where, "unknown or repeated key '{}'; expected 'materials' once", key);
    }
    if (value.kind != Kind::map)
      throw_user_error_at(value.where, "materials: expected a map of names or globs");
    found = true;
    sidecar.entries_ = value.members;
  }
  if (!found) throw_user_error_at({name, 1}, "expected a map with the key 'materials'");
  std::set<std::string_view> keys;
  for (const auto& [key, fields] : sidecar.entries_) {
    if (!keys.insert(key).second) throw_user_error_at(fields.where, "materials.{}: given twice", key);
    // Entries that this scene does not use are checked too, as if they were laid over some medium.
    RadioSources any_medium;
    any_medium.radio.emplace().layers.push_back({*itu_medium("vacuum"), 0.0});
    read_radio_fields(fields, any_medium);
  }
  return sidecar;
}

const RadioField* RadioSidecar::find(const std::string& material_name) const {
  for (const auto& [key, fields] : entries_) {
    if (key == material_name) return &fields;
  }
  for (const auto& [key, fields] : entries_) {
    if (fnmatch(key.c_str(), material_name.c_str(), 0) == 0) return &fields;
  }
  return nullptr;
}

}  // namespace greatx::scene
