// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "scene/generator/city/city_details.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "scene/generator/city/city_roofs.h"
#include "scene/generator/mesh/materials.h"

namespace greatx::scene::generator {

namespace {

constexpr double sunk_m = 0.06;  ///< how far a piece reaches into its wall

/// A wall as seen from outside: `along` from its start, `out` away from the building.
struct Wall {
  dvec2 start, along, out;
  double length;
  /// Returns the point `at` along the wall and `far` in front of it.
  dvec2 point(double at, double far) const { return snap(start + at * along + far * out); }
  /// Returns the corners of a rectangle in front of the wall, counter-clockwise from above.
  std::vector<dvec2> rectangle(double from, double to, double near, double far) const {
    return {point(from, near), point(from, far), point(to, far), point(to, near)};
  }
};

Wall wall_of(const Walls& walls, size_t edge) {
  const dvec2 a = walls.footprint[edge], b = walls.footprint[(edge + 1) % walls.footprint.size()];
  const dvec2 along = (b - a) / glm::length(b - a);
  return {a, along, dvec2(along.y, -along.x), glm::length(b - a)};
}

/// Returns the walls of at least this length that face no neighbour, the longest first.
std::vector<size_t> free_walls(const Walls& walls, double least_m) {
  std::vector<size_t> edges;
  for (size_t i = 0; i < walls.footprint.size(); ++i)
    if (!walls.alley[i] && wall_of(walls, i).length >= least_m) edges.push_back(i);
  std::stable_sort(edges.begin(), edges.end(), [&](size_t a, size_t b) {
    return wall_of(walls, a).length > wall_of(walls, b).length + 1e-6;
  });
  return edges;
}

/// Adds a box in front of a wall.
void add_block(MeshBuilder& mesh, int side, int top, const Wall& wall, const dvec2& along, const dvec2& far,
               double low_z, double high_z) {
  mesh.prism(side, top, wall.rectangle(along.x, along.y, far.x, far.y), low_z, high_z);
}

/// Adds a balcony as a tub: a slab, a parapet of 1 m with a rim of 6 cm, open above.
void add_tub(MeshBuilder& mesh, int parapet, const Wall& wall, double middle, double half, double depth,
             double z) {
  const int slab = material("concrete");
  RingSolid tub;
  tub.footprint = wall.rectangle(middle - half, middle + half, -0.1, depth);
  tub.bottom = slab;
  tub.rings = {
      {0.0, z - 0.16, parapet}, {0.0, z + 1.0, parapet}, {0.06, z + 1.0, parapet}, {0.06, z + 0.02, slab}};
  add_ring_solid(mesh, tub);
}

/// Adds a wedge of cloth that falls from the wall to its front edge, 4 cm thick.
void add_awning(MeshBuilder& mesh, int cloth, const Wall& wall, double from, double to, double depth,
                double low_z, double high_z) {
  const auto at = [&](double along, double far, double z) { return dvec3(wall.point(along, far), z); };
  const double thick = 0.05;
  const std::array<dvec3, 4> left{at(from, -sunk_m, high_z - thick), at(from, depth, low_z),
                                  at(from, depth, low_z + 0.18), at(from, -sunk_m, high_z)};
  // The other end is the same, moved by whole millimetres, so that all faces are planar.
  const dvec3 shift(snap((to - from) * wall.along), 0.0);
  std::array<dvec3, 4> right;
  for (size_t k = 0; k < 4; ++k) right[k] = left[k] + shift;
  for (size_t k = 0; k < 4; ++k) {
    const size_t next = (k + 1) % 4;
    mesh.quad(cloth, left[k], right[k], right[next], left[next]);
  }
  mesh.polygon(cloth, left);
  mesh.polygon(cloth, std::array{right[3], right[2], right[1], right[0]});
}

}  // namespace

void add_balconies(MeshBuilder& mesh, const Walls& walls, RandomStream& random) {
  static constexpr std::array<const char*, 4> looks{"parapet_white", "parapet_dark", "parapet_glass",
                                                    "concrete"};
  const int parapet = material(looks[random.below(4)]);
  const double depth = random.uniform(1.0, 1.3);
  const bool alternating = random.uniform() < 0.3;
  size_t used = 0;
  for (const size_t edge : free_walls(walls, 9.0)) {
    if (used++ >= 1) break;
    const Wall wall = wall_of(walls, edge);
    const int bays = std::max(1, static_cast<int>(std::lround(wall.length / walls.bay_m)));
    const double bay = wall.length / bays;
    const int columns = std::min(2, bays / 3);
    for (int column = 0; column < columns; ++column) {
      const int at = std::clamp(static_cast<int>(bays * (column + 0.5) / columns), 1, bays - 2);
      for (int floor = 1; floor < walls.floors; ++floor) {
        const int shifted = alternating && floor % 2 == 0 && at + 1 < bays - 1 ? at + 1 : at;
        add_tub(mesh, parapet, wall, (shifted + 0.5) * bay, 0.43 * bay, depth,
                walls.base_z + walls.floor_m * floor + 0.2);
      }
    }
  }
}

std::vector<std::pair<dvec2, dvec2>> add_shop_fronts(MeshBuilder& mesh, const Walls& walls,
                                                     RandomStream& random) {
  std::vector<std::pair<dvec2, dvec2>> places;
  static constexpr std::array<const char*, 4> cloths{"awning_red", "awning_green", "awning_blue",
                                                     "awning_sand"};
  static constexpr std::array<const char*, 4> boards{"post_yellow", "hydrant_red", "sign_blue",
                                                     "column_green"};
  for (const size_t edge : free_walls(walls, 6.0)) {
    const Wall wall = wall_of(walls, edge);
    const int shops = std::max(1, static_cast<int>(std::lround(wall.length / 6.0)));
    const double width = wall.length / shops;
    for (int shop = 0; shop < shops; ++shop) {
      const double from = shop * width;
      const double draw = random.uniform(), depth = random.uniform(1.0, 1.5);
      const uint32_t color = random.below(4);
      if (draw < 0.22)
        add_awning(mesh, material(cloths[color]), wall, from + 0.35, from + width - 0.35, depth, 2.5, 3.15);
      else if (draw < 0.32)  // a sign across the pavement
        add_block(mesh, material(boards[color]), material(boards[color]), wall,
                  {from + 0.5 * width - 0.05, from + 0.5 * width + 0.05}, {-sunk_m, 0.85}, 2.95, 3.6);
      if (draw < 0.04) places.emplace_back(wall.point(from + 0.5 * width, 0.0), wall.out);
    }
  }
  return places;
}

void add_entrance(MeshBuilder& mesh, const Walls& walls, RandomStream& random) {
  const std::vector<size_t> edges = free_walls(walls, 6.0);
  const double draw = random.uniform(0.3, 0.7);
  const bool dark = random.uniform() < 0.5;
  if (edges.empty()) return;
  const Wall wall = wall_of(walls, edges.front());
  const double at = draw * wall.length;
  const int frame = material("concrete"), door = material(dark ? "door_dark" : "door_boards");
  // No two of them end in one plane within the wall.
  add_block(mesh, door, door, wall, {at - 0.78, at + 0.78}, {-0.03, 0.13}, 0.08, 2.5);
  add_block(mesh, frame, frame, wall, {at - 1.15, at + 1.15}, {-0.08, 0.55}, -0.12, 0.1);
  add_block(mesh, frame, material("roof_zinc"), wall, {at - 1.25, at + 1.25}, {-0.07, 0.8}, 2.72, 2.86);
}

std::vector<std::pair<dvec2, dvec2>> add_scaffold(MeshBuilder& mesh, const Walls& walls, double top_z) {
  const std::vector<size_t> edges = free_walls(walls, 8.0);
  if (edges.size() < 2) return {};  // the longest wall has the door
  const Wall wall = wall_of(walls, edges[1]);
  const int tube = material("scaffold_tube"), board = material("bench_wood");
  const double from = 0.3, to = wall.length - 0.3, inner = 0.28, outer = 1.02;
  const int bays = std::max(2, static_cast<int>(std::lround((to - from) / 2.6)));
  for (int i = 0; i <= bays; ++i) {
    const double at = from + (to - from) * i / bays;
    for (const double far : {inner, outer}) {
      const std::vector<dvec2> corners{wall.point(at - 0.03, far - 0.02), wall.point(at, far + 0.03),
                                       wall.point(at + 0.03, far - 0.02)};
      mesh.prism(tube, tube, corners, -0.02, snap(top_z + (far == outer ? 1.1 : 0.12)));
    }
  }
  for (double z = 2.5; z < top_z; z += 2.0) {
    add_block(mesh, board, board, wall, {from - 0.1, to + 0.1}, {inner + 0.04, outer - 0.04}, snap(z - 0.05),
              snap(z));
    add_block(mesh, tube, tube, wall, {from - 0.05, to + 0.05}, {outer + 0.025, outer + 0.065},
              snap(z + 0.98), snap(z + 1.02));
  }
  std::vector<std::pair<dvec2, dvec2>> fences;
  const int elements = static_cast<int>((to - from) / 3.7);
  for (int i = 0; i < std::min(elements, 4); ++i)
    fences.emplace_back(wall.point(from + 1.85 + 3.7 * i, 0.8), wall.out);
  return fences;
}

void add_downpipes(MeshBuilder& mesh, const Walls& walls, double top_z, RandomStream& random) {
  const int zinc = material("downpipe");
  for (size_t edge = 0; edge < walls.footprint.size(); ++edge) {
    const bool wanted = random.uniform() < 0.25;
    const Wall wall = wall_of(walls, edge);
    if (!wanted || wall.length < 6.0) continue;
    add_block(mesh, zinc, zinc, wall, {0.3, 0.4}, {-0.04, 0.1}, -0.1, top_z - 0.03);
  }
}

void add_roof_clutter(MeshBuilder& mesh, const std::vector<dvec2>& roof, std::vector<dvec2> taken,
                      const dvec2& along, double roof_z, bool tall, RandomStream& random) {
  const dvec2 across(-along.y, along.x);
  dvec2 low(1e9), high(-1e9);
  for (const dvec2& p : roof) {
    low = glm::min(low, p);
    high = glm::max(high, p);
  }
  const int sheet = material("roof_equipment"), steel = material("galvanised_metal");
  const int wanted = 1 + static_cast<int>(random.below(2));
  int placed = 0;
  for (int attempt = 0; attempt < 24 && placed < wanted; ++attempt) {
    const dvec2 spot = snap(dvec2(random.uniform(low.x, high.x), random.uniform(low.y, high.y)));
    const uint32_t kind = random.below(4);
    const double size = random.uniform();
    const dvec2 half = kind == 0 ? dvec2(1.4 + size, 0.22) : kind == 1 ? dvec2(0.16) : dvec2(0.5);
    std::vector<dvec2> corners;
    for (const dvec2& c : {dvec2(-1, -1), dvec2(1, -1), dvec2(1, 1), dvec2(-1, 1)})
      corners.push_back(snap(spot + along * (c.x * half.x) + across * (c.y * half.y)));
    const bool fits =
        std::all_of(corners.begin(), corners.end(), [&](const dvec2& c) { return inside(roof, c); }) &&
        std::all_of(taken.begin(), taken.end(),
                    [&](const dvec2& other) { return glm::length(other - spot) > 3.6 + half.x; });
    if (!fits) continue;
    taken.push_back(spot);
    ++placed;
    const auto box = [&](const dvec2& at, const dvec2& reach, double from, double to, int of) {
      std::vector<dvec2> rim;
      for (const dvec2& c : {dvec2(-1, -1), dvec2(1, -1), dvec2(1, 1), dvec2(-1, 1)})
        rim.push_back(snap(at + along * (c.x * reach.x) + across * (c.y * reach.y)));
      mesh.prism(of, of, rim, snap(roof_z + from), snap(roof_z + to));
    };
    if (kind == 0) {  // a duct
      box(spot, half, 0.16, 0.56, sheet);
      box(spot, half * dvec2(0.8, 0.5), -0.12, 0.2, steel);
    } else if (kind == 1) {  // a pipe with a cowl
      box(spot, {0.11, 0.11}, -0.12, 0.7 + 0.4 * size, steel);
      box(spot, {0.19, 0.19}, 0.66 + 0.4 * size, 0.82 + 0.4 * size, sheet);
    } else if (kind == 2 && tall) {  // an antenna
      const double top = 2.0 + size;
      box(spot, {0.03, 0.03}, -0.12, top, steel);
      box(spot, {0.5, 0.02}, top - 0.1, top - 0.05, steel);
    } else {  // a fan
      box(spot, {0.5, 0.5}, -0.12, 0.5, sheet);
      box(spot, {0.3, 0.3}, 0.46, 0.7, steel);
    }
  }
}

}  // namespace greatx::scene::generator
