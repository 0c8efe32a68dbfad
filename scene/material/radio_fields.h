// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// The radio fields of docs/materials.md, read by one parser from JSON (the extension) and from YAML (the
// sidecar).
#pragma once

#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <nlohmann/json_fwd.hpp>

#include "core/error.h"
#include "scene/material/material.h"

namespace greatx::scene {

/// A value of a JSON or YAML document and the place where it stands.
struct RadioField {
  enum class Kind { null, boolean, number, text, list, map } kind = Kind::null;
  bool boolean = false;
  double number = 0.0;
  std::string text;
  std::vector<RadioField> items;                            ///< of a list
  std::vector<std::pair<std::string, RadioField>> members;  ///< of a map, in the document's order
  SourceLocation where;
  std::string path;  ///< e.g. "materials.wall.layers[1].thickness_m"
};

/// A JSON value; `what` starts every message ("x.glb: material 'wall'").
RadioField field_from_json(const nlohmann::json& value, const std::string& what, const std::string& path);

/// What one source (name, extension or sidecar) says about a material, laid over what the sources below it
/// say.
struct RadioSources {
  std::optional<RadioMaterial> radio;
  std::optional<float> reflectance_905nm, reflectance_1550nm;
};

/// Lays `fields` (a map) over `below`. Throws UserError naming place and field: unknown key, wrong type, out
/// of range, unknown ITU name, no medium where one is needed.
RadioSources read_radio_fields(const RadioField& fields, const RadioSources& below);

/// "itu_concrete", "ITU-Concrete.001", "mat-itu_concrete" -> "concrete" as written; empty if the name is none
/// of ITU's form. It may still be unknown to the table.
std::optional<std::string> itu_part_of_name(const std::string& material_name);

}  // namespace greatx::scene
