// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Reads the radio fields of docs/materials.md. One parser reads them from JSON (the extension) and from YAML
// (the sidecar).
#pragma once

#include <optional>
#include <string>

#include <nlohmann/json_fwd.hpp>

#include "core/fields/field.h"
#include "scene/material/material.h"

namespace greatx::scene {

/// Returns the JSON value at `path` as a Field; `what` starts every message ("x.glb: material 'wall'").
Field field_from_json(const nlohmann::json& json, const std::string& what, const std::string& path);

/// Describes the statements of one source (name, extension or sidecar) about a material, laid over those of
/// the sources below it.
struct RadioSources {
  std::optional<RadioMaterial> radio;
  std::optional<float> reflectance_905nm, reflectance_1550nm;
};

/// Lays `fields` (a map) over `below`. Throws UserError naming place and field for an unknown key, a wrong
/// type, a value out of range, an unknown ITU name, or a missing medium where one is needed.
RadioSources read_radio_fields(const Field& fields, const RadioSources& below);

/// Sets whether the media of a material, those of its windows among them, extrapolate beyond their ranges.
void set_extrapolate(RadioMaterial& material, bool extrapolate);

/// Returns the ITU part of a name as written: "itu_concrete", "ITU-Concrete.001", "mat-itu_concrete" ->
/// "concrete". The result is empty if the name does not have ITU's form. The table may still not know the
/// name.
std::optional<std::string> itu_part_of_name(const std::string& material_name);

}  // namespace greatx::scene
