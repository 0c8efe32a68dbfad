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
  /// repeated key.
  static RadioSidecar read(const std::filesystem::path& file);

  /// Returns the fields for `material_name`: the entry of that exact name, else the first glob that matches,
  /// else null.
  const Field* find(const std::string& material_name) const;

 private:
  std::vector<std::pair<std::string, Field>> entries_;
};

}  // namespace greatx::scene
