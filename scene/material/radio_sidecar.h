// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "scene/material/radio_fields.h"

namespace greatx::scene {

/// Represents the YAML file that maps material names or globs to radio fields (docs/materials.md).
class RadioSidecar {
 public:
  /// Makes a sidecar without entries.
  RadioSidecar() = default;
  /// Throws UserError with file:line if the file is not YAML, has no `materials` map, or has an unknown or
  /// repeated key, or a wrong value.
  static RadioSidecar read(const std::filesystem::path& file);

  /// Returns the fields for `material_name`: the entry of that exact name, else the first glob that matches,
  /// else null.
  const Field* find(const std::string& material_name) const;

  /// Applies `beyond_range: extrapolate` to a material that is otherwise complete: every medium then uses its
  /// nearest row outside its ranges, unless the material's entry has an `extrapolate` of its own.
  void extrapolate(const std::string& material_name, RadioMaterial& material) const;

 private:
  std::vector<std::pair<std::string, Field>> entries_;
  bool extrapolate_ = false;
};

}  // namespace greatx::scene
