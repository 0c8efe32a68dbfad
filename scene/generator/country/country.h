// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Farmland on a Terrain: country.cpp has sites, fields and ground, country_things.cpp what stands there.
#pragma once

#include <algorithm>
#include <array>
#include <functional>
#include <map>
#include <string>
#include <vector>

#include "core/random.h"
#include "scene/generator/country/terrain.h"
#include "scene/generator/mesh/glb_writer.h"

namespace greatx::scene::generator {

void write_country(GlbWriter& writer, double size_m, uint64_t seed);

/// Fields: on each side of the road two bands, each cut across at rows of its own.
struct Field {
  int row0, row1, column0, column1;  ///< cells [row0, row1) x [column0, column1)
  int material;
  double angle = 0.0;  ///< of its rows, rad
  dvec2 offset{0.0};   ///< of its texture
};

class Country {
 public:
  Country(GlbWriter& writer, double size_m, uint64_t seed)
      : writer_(writer), random_(seed, 5), terrain_(size_m, random_) {}

  void write() {
    choose_sites();
    terrain_.build_grid();
    choose_fields();
    add_ground();
    add_hedges();
    add_farms();
    add_woods();
    add_poles();
    add_lamps();
  }

 private:
  dvec2 find_pond();
  void choose_sites();
  /// Fields of a band that are not for crops, by row.
  std::vector<Field> reserved(const std::array<int, 2>& band) const;
  double wood_radius() const { return std::min(0.2 * terrain_.half(), 26.0); }
  void choose_fields();
  void add_ground();
  void add_hedges();
  void add_farms();
  void add_woods();
  void add_poles();
  void add_lamps();
  void add_tree(const dvec2& where, bool conifer);
  bool near_site(const dvec2& point, double margin) const;
  int shared(const std::string& name, const std::function<MeshBuilder()>& make);
  void add(const std::string& name, const MeshBuilder& mesh, SemanticClass semantic_class) {
    writer_.add_node({.name = name, .mesh = writer_.add_mesh(name, mesh), .semantic_class = semantic_class});
  }

  GlbWriter& writer_;
  RandomStream random_;
  Terrain terrain_;
  std::vector<Site> farms_;
  Site pond_;
  std::vector<dvec2> woods_;
  std::vector<Field> fields_;
  std::map<std::string, int> meshes_;
  int tree_count_ = 0;
};

}  // namespace greatx::scene::generator
