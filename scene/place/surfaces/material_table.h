// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// The table of materials of places: from classes ("facade/brick", "roof/tiles", "ground/road") to materials
// with optical and radio properties. greatx has a table; a file may replace entries of it (docs/places.md).
#pragma once

#include <array>
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "scene/generator/mesh/materials.h"

namespace greatx::scene::place {

class MaterialTable {
 public:
  /// Makes greatx's own table.
  MaterialTable();
  /// Replaces classes by those of a file. Throws UserError "file:line: field: expected ..., found ..." for a
  /// class that does not exist, an unknown material, or wrong properties.
  void read(const std::filesystem::path& file);
  void read_text(const std::string& text, const std::string& name);

  /// Returns the material of a class: one of its choices, by `draw` in [0, 1).
  int of(const std::string& material_class, double draw = 0.0) const;
  /// Returns a variant of a material in another colour: the median of its texture times its colour becomes
  /// this one, or as near to it as a factor of at most 1 takes it. The texture keeps its pattern.
  int coloured(int material, const std::array<unsigned char, 3>& srgb);
  /// Returns a variant of a material that shows a picture instead of its texture.
  int pictured(int material, const std::string& picture, size_t number);

  /// Returns all materials: those of the generator, which keep their numbers, then the table's own.
  const std::vector<generator::MaterialSpec>& materials() const { return materials_; }
  const generator::MaterialSpec& operator[](int material) const {
    return materials_[static_cast<size_t>(material)];
  }
  /// Returns the classes and the names of their choices, for the report.
  std::vector<std::pair<std::string, std::vector<std::string>>> listing() const;

  /// Returns the YAML of greatx's own table.
  static const std::string& default_text();

 private:
  int add(generator::MaterialSpec spec);
  /// The median of a texture's pixels by channel, linear; 1 without a texture. Walls have more pixels than
  /// their windows, so it is the wall's colour.
  vec3 median_of(const std::string& texture);

  std::vector<generator::MaterialSpec> materials_;
  std::map<std::string, std::vector<int>, std::less<>> classes_;
  std::map<std::string, int> variants_;  ///< by name
  std::map<std::string, vec3> medians_;  ///< by texture
};

}  // namespace greatx::scene::place
