// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Reads the radio fields of docs/materials.md. One parser reads them from JSON (the extension) and from YAML
// (the sidecar).
#pragma once

#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <nlohmann/json_fwd.hpp>

#include "core/error.h"
#include "scene/material/material.h"

namespace greatx::scene {

/// Describes a value of a JSON or YAML document, and its place.
struct RadioField {
  enum class Kind { null, boolean, number, text, list, map } kind = Kind::null;
  bool boolean = false;
  double number = 0.0;
  std::string text;
  std::vector<RadioField> items;                            ///< elements of a list
  std::vector<std::pair<std::string, RadioField>> members;  ///< members of a map, in the document's order
  SourceLocation where;
  std::string path;  ///< e.g. "materials.wall.layers[1].thickness_m"
};

/// Returns a JSON value as a RadioField; `what` starts every message ("x.glb: material 'wall'").
RadioField field_from_json(const nlohmann::json& value, const std::string& what, const std::string& path);

/// Describes the statements of one source (name, extension or sidecar) about a material, laid over those of
/// the sources below it.
struct RadioSources {
  std::optional<RadioMaterial> radio;
  std::optional<float> reflectance_905nm, reflectance_1550nm;
};

/// Lays `fields` (a map) over `below`. Throws UserError naming place and field for an unknown key, a wrong
/// type, a value out of range, an unknown ITU name, or a missing medium where one is needed.
RadioSources read_radio_fields(const RadioField& fields, const RadioSources& below);

/// Returns the ITU part of a name as written: "itu_concrete", "ITU-Concrete.001", "mat-itu_concrete" ->
/// "concrete". The result is empty if the name does not have ITU's form. The table may still not know the
/// name.
std::optional<std::string> itu_part_of_name(const std::string& material_name);

}  // namespace greatx::scene
