// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "scene/place/assemble/building_mesh.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <utility>

#include <fmt/format.h>

#include "core/random.h"
#include "scene/place/assemble/windows.h"

namespace greatx::scene::place {

namespace {

constexpr double bay_m = 3.0;  ///< width of a bay of the façades, which is stretched to fit
constexpr double narrowest_facade_m = 1.6;
constexpr double turn_cosine = 0.9994;  ///< walls within 2 degrees go on

/// Where an edge lies on its façade.
struct Run {
  double start = 0.0, length = 0.0;  ///< of the edge on the façade, and of the whole façade, m
  uint32_t number = 0;               ///< of the façade in its building
};
using RunKey = std::pair<GridPoint, GridPoint>;

/// Joins the edges of a building's walls to straight façades.
std::map<RunKey, Run> find_runs(const std::vector<const WallPiece*>& walls) {
  std::map<RunKey, Run> runs;
  std::map<GridPoint, std::vector<GridPoint>> from, to;
  for (const WallPiece* wall : walls)
    if (runs.emplace(RunKey{wall->from, wall->to}, Run{}).second) {
      from[wall->from].push_back(wall->to);
      to[wall->to].push_back(wall->from);
    }
  const auto direction = [](const GridPoint& a, const GridPoint& b) {
    return glm::normalize(to_metres(b) - to_metres(a));
  };
  // The edge that goes on straight, if exactly one starts where this one ends.
  const auto successor = [&](const RunKey& edge) -> const GridPoint* {
    const auto found = from.find(edge.second);
    if (found == from.end() || found->second.size() != 1 || to[edge.second].size() != 1) return nullptr;
    const GridPoint& next = found->second.front();
    return glm::dot(direction(edge.first, edge.second), direction(edge.second, next)) > turn_cosine ? &next
                                                                                                    : nullptr;
  };
  std::map<RunKey, bool> has_predecessor;
  for (const auto& [edge, run] : runs)
    if (const GridPoint* next = successor(edge)) has_predecessor[{edge.second, *next}] = true;
  uint32_t number = 0;
  for (auto& [edge, run] : runs) {
    if (has_predecessor.count(edge) > 0) continue;
    std::vector<RunKey> chain{edge};
    double length = glm::distance(to_metres(edge.first), to_metres(edge.second));
    while (const GridPoint* next = successor(chain.back())) {
      chain.push_back({chain.back().second, *next});
      length += glm::distance(to_metres(chain.back().first), to_metres(*next));
    }
    double start = 0.0;
    for (const RunKey& part : chain) {
      runs[part] = {start, length, number};
      start += glm::distance(to_metres(part.first), to_metres(part.second));
    }
    ++number;
  }
  return runs;
}

/// Kinds of buildings whose walls have no rows of windows as housing and offices have.
bool without_windows(const std::string& use) {
  static const std::array<const char*, 24> kinds{
      "church", "cathedral", "chapel",       "monastery", "mosque",  "synagogue",
      "temple", "shrine",    "barn",         "stable",    "sty",     "cowshed",
      "shed",   "hut",       "garage",       "garages",   "carport", "water_tower",
      "silo",   "bunker",    "storage_tank", "roof",      "ruins",   "transformer_tower"};
  return std::find(kinds.begin(), kinds.end(), use) != kinds.end();
}

/// The materials of one building.
struct Look {
  int facade = 0, blind = 0, party = 0, floor = 0, window = 0;
  bool windows = false;  ///< as faces of their own
  int storeys = 1;
  std::vector<int> roofs;  ///< by part
  double storey_m = 3.0, base_z = 0.0;
};

Look look_of(const Building& building, uint32_t index, const BuildingConfig& config, MaterialTable& table) {
  RandomStream random(config.seed, 71, index);
  Look look;
  const bool blind = config.facades == FacadeDetail::plain || without_windows(building.use);
  const std::string facade = (blind ? "blind/" : "facade/") + building.facade_class;
  look.facade = table.of(facade, random.uniform());
  look.blind = table.of("blind/" + building.facade_class, random.uniform());
  if (building.facade_colour) {
    look.facade = table.coloured(look.facade, *building.facade_colour);
    look.blind = table.coloured(look.blind, *building.facade_colour);
  }
  look.windows = config.facades == FacadeDetail::geometry && !without_windows(building.use);
  look.window = table.of("window");
  look.storeys = std::max(1, building.storeys);
  look.party = table.of("party");
  look.floor = table.of("floor");
  const double roof_draw = random.uniform();
  double eaves = building.ground_z;
  for (const Part& part : building.parts) {
    int roof = table.of("roof/" + part.roof_class, roof_draw);
    if (part.roof_colour) roof = table.coloured(roof, *part.roof_colour);
    look.roofs.push_back(roof);
    eaves = std::max(eaves, part.eaves_z);
  }
  look.base_z = building.ground_z;
  const double storey = (eaves - building.ground_z) / std::max(1, building.storeys);
  look.storey_m = storey >= 2.2 && storey <= 6.0 ? storey : building.floor_height_m;
  return look;
}

class Facades {
 public:
  Facades(const Look& look, const MaterialTable& table, const BuildingConfig& config, uint32_t building)
      : look_(look), table_(table), config_(config), building_(building) {}

  void add(const WallPiece& wall, const Run& run, PlaceMesh& mesh) const {
    int material = look_.facade;
    if (wall.neighbour != no_building)
      material = look_.party;
    else if (wall.beside_neighbour || run.length < narrowest_facade_m || below_ground(wall))
      material = look_.blind;
    if (material == look_.facade && look_.windows) {
      const WindowLattice lattice{run.start, run.length / bays_of(run), look_.base_z, look_.storey_m,
                                  look_.storeys};
      for (const WallTriangle& part : with_windows(wall, lattice))
        add_triangle(part.window ? look_.window : look_.blind, wall, run, part.corners, mesh);
      return;
    }
    for (const auto& corners : triangles_of(wall)) add_triangle(material, wall, run, corners, mesh);
  }

 private:
  static double bays_of(const Run& run) { return std::max(1.0, std::round(run.length / bay_m)); }

  void add_triangle(int material, const WallPiece& wall, const Run& run, const std::array<dvec3, 3>& corners,
                    PlaceMesh& mesh) const {
    const generator::MaterialSpec& spec = table_[material];
    const dvec2 from = to_metres(wall.from), along = glm::normalize(to_metres(wall.to) - from);
    const dvec3 normal(along.y, -along.x, 0.0);
    std::array<dvec2, 3> uvs;
    for (size_t i = 0; i < 3; ++i) {
      const double s = run.start + glm::dot(dvec2(corners[i]) - from, along);
      uvs[i] = spec.bays > 0 ? facade_uv(spec, run, s, corners[i].z)
                             : dvec2(s / spec.tile_m.x, -(corners[i].z - look_.base_z) / spec.tile_m.y);
    }
    mesh.triangle(material, corners, {normal, normal, normal}, uvs);
  }

  bool below_ground(const WallPiece& wall) const {
    return std::max(wall.from_z.back(), wall.to_z.back()) < look_.base_z + 0.5;
  }

  /// A façade begins at a bay of its own, so that walls differ. A tile has two storeys.
  dvec2 facade_uv(const generator::MaterialSpec& spec, const Run& run, double s, double z) const {
    const double bays = bays_of(run);
    RandomStream random(config_.seed, 72 + building_, run.number);
    const double first = random.below(static_cast<uint32_t>(spec.bays));
    return {(first + s / run.length * bays) / spec.bays, -(z - look_.base_z) / (2.0 * look_.storey_m)};
  }

  const Look& look_;
  const MaterialTable& table_;
  const BuildingConfig& config_;
  uint32_t building_;
};

void add_flat(const FlatFace& face, const Look& look, const PictureCover& pictures, MaterialTable& table,
              PlaceMesh& mesh) {
  const auto& c = face.corners;
  const dvec3 cross = glm::cross(c[1] - c[0], c[2] - c[0]);
  if (!(glm::length(cross) > 1e-9)) return;
  const dvec3 normal = glm::normalize(cross);
  int material = face.kind == FlatFace::Kind::roof ? look.roofs[face.part] : look.floor;
  std::array<dvec2, 3> uvs;
  const auto picture =
      face.kind == FlatFace::Kind::roof ? pictures.over(dvec2(c[0]), dvec2(c[1]), dvec2(c[2])) : std::nullopt;
  if (picture) material = table.pictured(material, pictures.name(*picture), *picture);
  for (size_t i = 0; i < 3; ++i)
    uvs[i] = picture ? pictures.uv(*picture, dvec2(c[i]))
                     : uv_on_plane(table[material].tile_m, c[i] - mesh.anchor(), normal);
  mesh.triangle(material, c, {normal, normal, normal}, uvs);
}

}  // namespace

std::vector<PlaceMesh> building_meshes(const std::vector<Building>& buildings, const Complex& complex,
                                       const BuildingConfig& config, const PictureCover& pictures,
                                       MaterialTable& table) {
  std::vector<std::vector<const WallPiece*>> walls(buildings.size());
  std::vector<std::vector<const FlatFace*>> flats(buildings.size());
  for (const WallPiece& wall : complex.walls) walls[wall.building].push_back(&wall);
  for (const FlatFace& face : complex.flats) flats[face.building].push_back(&face);
  std::vector<PlaceMesh> meshes;
  for (uint32_t i = 0; i < buildings.size(); ++i) {
    Box box;
    for (const WallPiece* wall : walls[i]) {
      box.add(to_metres(wall->from));
      box.add(to_metres(wall->to));
    }
    if (box.empty()) {
      meshes.emplace_back();
      continue;
    }
    const dvec2 middle = glm::floor(0.5 * (box.low + box.high));
    PlaceMesh& mesh = meshes.emplace_back(dvec3(middle, std::floor(buildings[i].ground_z)));
    const Look look = look_of(buildings[i], i, config, table);
    const std::map<RunKey, Run> runs = find_runs(walls[i]);
    const Facades facades(look, table, config, i);
    for (const WallPiece* wall : walls[i]) facades.add(*wall, runs.at({wall->from, wall->to}), mesh);
    for (const FlatFace* face : flats[i]) add_flat(*face, look, pictures, table, mesh);
  }
  return meshes;
}

}  // namespace greatx::scene::place
