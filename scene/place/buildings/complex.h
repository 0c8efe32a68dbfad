// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Turns the columns of all buildings into faces, each once. The plan of all outlines and roof edges is one
// triangulation, whose regions hold layers (a building from a bottom plane to a top plane). Surfaces are
// where solid meets air or another building:
//   in a region     between layers: roofs and floors
//   at an edge      between the layers on its left and on its right: walls
// Heights at a corner of the plan that differ by 1 cm or less become one, and every wall has all heights
// of its corners as its own corners. Therefore faces meet at whole edges, within a building and between
// buildings, and no face is of 1 cm or less because of heights that nearly agree.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "scene/place/buildings/building.h"
#include "scene/place/plane/grid.h"

namespace greatx::scene::place {

inline constexpr uint32_t no_building = 0xFFFFFFFFu;
/// Heights at one corner of the plan that are nearer than this are one height: sources that round to whole
/// centimetres give many steps of one, which would be slivers.
inline constexpr double same_height_m = 0.0102;

/// A wall over one edge of the plan. Its outside is on the right of the way from `from` to `to`.
struct WallPiece {
  uint32_t building = 0;             ///< that it belongs to
  uint32_t neighbour = no_building;  ///< a party wall: the building on its outside
  bool beside_neighbour = false;     ///< another building stands at this edge, above or below
  GridPoint from, to;
  std::vector<double> from_z, to_z;  ///< heights of the corners, ascending, m on the grid; 1 or more
  uint32_t part = 0;
};

/// A triangle of a roof or a floor, seen from outside counter-clockwise.
struct FlatFace {
  enum class Kind { roof, floor, slab } kind = Kind::roof;  ///< slab: between two buildings
  uint32_t building = 0, part = 0;
  uint32_t neighbour = no_building;  ///< a slab: the building above
  std::array<dvec3, 3> corners;
};

struct Complex {
  std::vector<WallPiece> walls;
  std::vector<FlatFace> flats;
  std::vector<double> built_area_m2;  ///< of each building: the plan that it has above any other
  double most_welded_m = 0.0;         ///< largest change of a height
  double most_moved_m = 0.0;          ///< largest distance of a corner of an outline from what was built
};

struct ComplexOptions {
  double foundation_m = 0.5;  ///< depth of foundations below the lowest ground
  /// Corners and walls nearer than this become one; gaps and slivers of a mean width below this are closed.
  double weld_m = 0.05;
  double simplify_m = 0.01;  ///< corners go if the outline then moves by less than this
};

/// Makes the faces. Where buildings overlap, the higher one stands; what that takes from the other one is a
/// Finding. Throws UserError if the buildings span more than most_extent_m.
Complex make_complex(std::vector<Building>& buildings, const ComplexOptions& options,
                     std::vector<Finding>& findings);

/// Returns the triangles of a wall, seen from outside counter-clockwise.
std::vector<std::array<dvec3, 3>> triangles_of(const WallPiece& wall);

}  // namespace greatx::scene::place
