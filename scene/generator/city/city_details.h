// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Adds what stands out of the walls and roofs of the city's buildings. All pieces are closed solids that
// reach a little into the wall or the roof, so that walls stay plane.
#pragma once

#include <utility>
#include <vector>

#include "core/random.h"
#include "scene/generator/mesh/mesh_builder.h"

namespace greatx::scene::generator {

/// Describes the walls of a building that has grown up to its roof.
struct Walls {
  std::vector<dvec2> footprint;  ///< counter-clockwise
  std::vector<bool> alley;       ///< whether edge i faces a neighbour
  double base_z = 0.0;           ///< where the façade's first floor begins
  double floor_m = 3.2;
  int floors = 0;  ///< above base_z
  double bay_m = 3.0;
};

/// Adds balconies in columns on one of the walls that face a street or a yard: a slab with a parapet
/// on every floor but the first.
void add_balconies(MeshBuilder& mesh, const Walls& walls, RandomStream& random);
/// Adds awnings of some shops, and signs that stand out of the wall. Returns places in front of the walls
/// where tables may stand: points on the wall, and the direction away from it.
std::vector<std::pair<dvec2, dvec2>> add_shop_fronts(MeshBuilder& mesh, const Walls& walls,
                                                     RandomStream& random);
/// Adds a door with a step and a canopy on one wall, for buildings without shops.
void add_entrance(MeshBuilder& mesh, const Walls& walls, RandomStream& random);
/// Adds a scaffold up to `top_z` before the second longest wall that faces no neighbour, if it has at least
/// 8 m: two rows of standards, boards every 2 m, and rails. Returns places for elements of a fence, 3.4 m
/// long, as add_shop_fronts does. Nothing is farther than 1.2 m from the wall.
std::vector<std::pair<dvec2, dvec2>> add_scaffold(MeshBuilder& mesh, const Walls& walls, double top_z);
/// Adds pipes from the eaves down, at some corners.
void add_downpipes(MeshBuilder& mesh, const Walls& walls, double top_z, RandomStream& random);
/// Adds ducts, vents and antennas to a flat roof, where they fit within `roof` and keep away from the
/// places `taken`. `tall` allows antennas of up to 3 m.
void add_roof_clutter(MeshBuilder& mesh, const std::vector<dvec2>& roof, std::vector<dvec2> taken,
                      const dvec2& along, double roof_z, bool tall, RandomStream& random);

}  // namespace greatx::scene::generator
