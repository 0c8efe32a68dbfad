// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Plans the city as seen from above: straight, slightly tilted streets that cross, and blocks with rounded
// corners between them. Streets, junctions and blocks share their corners exactly, so that the ground is one
// closed surface.
#pragma once

#include <array>
#include <vector>

#include "core/random.h"
#include "core/vec.h"

namespace greatx::scene::generator {

/// Describes a block. Its edges are 0 south, 1 east, 2 north, 3 west. Corner i lies between the edges i - 1
/// and i: south-west, south-east, and so on.
struct Block {
  int column = 0, row = 0;
  std::array<bool, 4> street{};        ///< whether a street runs along the edge (else the model ends there)
  std::array<double, 4> pavement_m{};  ///< width of the pavement along each edge
  std::array<dvec2, 4> sharp;          ///< corners before rounding
  std::array<std::vector<dvec2>, 4> corners;  ///< one point, or four on an arc; counter-clockwise
  std::vector<dvec2> outline() const;
  /// Returns the width of the pavement along each edge of outline().
  std::vector<double> outline_insets() const;
  dvec2 edge_start(int edge) const { return corners[static_cast<size_t>(edge)].back(); }
  dvec2 edge_end(int edge) const { return corners[static_cast<size_t>((edge + 1) % 4)].front(); }
};

/// A stretch of street between two junctions, or between a junction and the edge of the model.
struct Street {
  /// Kerb lines, as seen in the direction of increasing x or y; [0] is the start, [1] the end.
  dvec2 left[2], right[2];
  bool avenue = false;
  bool junction[2] = {false, false};  ///< whether the street ends at a junction
  bool crossing[2] = {false, false};  ///< whether a zebra crosses the street there
};

struct CityPlan {
  double half_m = 0.0;
  int blocks = 0;            ///< per side, even
  std::vector<Block> block;  ///< row by row from the south-west
  std::vector<Street> streets;
  std::vector<std::vector<dvec2>> junctions;  ///< outlines, counter-clockwise
  const Block& at(int column, int row) const { return block[static_cast<size_t>(row * blocks + column)]; }
};

CityPlan plan_city(double size_m, uint64_t seed);

}  // namespace greatx::scene::generator
