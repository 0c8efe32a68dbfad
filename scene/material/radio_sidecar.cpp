// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "scene/material/radio_sidecar.h"

#include <fnmatch.h>

#include "core/input_file.h"

namespace greatx::scene {

RadioSidecar RadioSidecar::read(const std::filesystem::path& file) {
  const std::string text = InputFile(file, "radio materials", budget::yaml_file).text();
  const FieldMap root(Field::parse_yaml(text, {file.string(), {}, {}}), {"materials", "beyond_range"});
  RadioSidecar sidecar;
  sidecar.entries_ = root.require("materials", "a map of names or globs").entries();
  if (const auto beyond = root.find("beyond_range"))
    sidecar.extrapolate_ = beyond->choice({"refuse", "extrapolate"}) == 1;
  for (const auto& [key, fields] : sidecar.entries_) {
    // Entries that this scene does not use are checked too, as if laid over some wall with windows.
    RadioSources any_medium;
    any_medium.radio.emplace().layers.push_back({*itu_medium("vacuum"), 0.0});
    any_medium.radio->windows = RadioWindows{0.0, {{*itu_medium("vacuum"), 1.0}}};
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

void RadioSidecar::extrapolate(const std::string& material_name, RadioMaterial& material) const {
  if (!extrapolate_) return;
  if (const Field* entry = find(material_name))
    for (const auto& [key, value] : entry->entries())
      if (key == "extrapolate") return;
  set_extrapolate(material, true);
}

}  // namespace greatx::scene
