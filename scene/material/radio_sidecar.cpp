// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "scene/material/radio_sidecar.h"

#include <fnmatch.h>

#include "core/input_file.h"

namespace greatx::scene {

RadioSidecar RadioSidecar::read(const std::filesystem::path& file) {
  const std::string text = InputFile(file, "radio materials", budget::yaml_file).text();
  const FieldMap root(Field::parse_yaml(text, {file.string(), {}, {}}), {"materials"});
  RadioSidecar sidecar;
  sidecar.entries_ = root.require("materials", "a map of names or globs").entries();
  for (const auto& [key, fields] : sidecar.entries_) {
    // Entries that this scene does not use are checked too, as if laid over some medium.
    RadioSources any_medium;
    any_medium.radio.emplace().layers.push_back({*itu_medium("vacuum"), 0.0});
    read_radio_fields(fields, any_medium);
  }
  return sidecar;
}

const Field* RadioSidecar::find(const std::string& material_name) const {
  for (const auto& [key, fields] : entries_) {
    if (key == material_name) return &fields;
  }
  for (const auto& [key, fields] : entries_) {
    if (fnmatch(key.c_str(), material_name.c_str(), 0) == 0) return &fields;
  }
  return nullptr;
}

}  // namespace greatx::scene
