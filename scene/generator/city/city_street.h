// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Places the small pieces of the city's pavements.
#pragma once

#include <array>
#include <functional>
#include <map>
#include <string>
#include <vector>

#include "scene/generator/city/city_plan.h"
#include "scene/generator/mesh/scene_writer.h"

namespace greatx::scene::generator {

/// Places on the four edges of a block's pavement that are taken, m along the edge.
using TakenPlaces = std::array<std::vector<double>, 4>;

/// One edge of a block's pavement: the kerb from `start`, and the direction into the block.
struct Kerb {
  Kerb(const Block& block, int edge);
  dvec2 start, along, inwards;
  double length;
  bool avenue;
  /// Returns the point `at` m along the kerb and `depth` m into the block.
  dvec2 spot(double at, double depth) const { return start + along * at + inwards * depth; }
};

/// Places pieces on pavements. People walk within 0.6 m of a line that is 3.1 m from the kerb of an avenue
/// and 2.0 m from that of another street, and they cross the street at its ends. Pieces keep away from
/// both.
class CityStreet {
 public:
  CityStreet(SceneWriter& writer, uint64_t seed) : writer_(writer), seed_(seed) {}
  /// Places pieces along the kerbs of a block, at places that are not taken.
  void furnish(const Block& block, const TakenPlaces& taken);
  /// Places the grate of a tree whose street runs along `yaw`.
  void grate(const dvec2& where, double yaw);
  /// Places tables in front of a wall that looks towards `out`.
  void cafe(const dvec2& where, const dvec2& out);

 private:
  using Make = std::function<MeshBuilder()>;
  void place(const std::string& name, const std::string& mesh, const Make& make, const dvec2& where,
             double yaw, SemanticClass semantic_class = SemanticClass::furniture);

  SceneWriter& writer_;
  uint64_t seed_;
  std::map<std::string, int> meshes_, counts_;
};

}  // namespace greatx::scene::generator
