// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "scene/generator/country/country.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <map>
#include <string>
#include <vector>

#include <fmt/format.h>

#include "core/random.h"
#include "core/units.h"
#include "scene/generator/country/terrain.h"
#include "scene/generator/mesh/materials.h"
#include "scene/generator/objects/farm.h"
#include "scene/generator/objects/objects.h"
#include "scene/generator/objects/street_furniture.h"
#include "scene/generator/objects/trees.h"
#include "scene/generator/objects/vehicles.h"
#include "scene/generator/objects/wires.h"

namespace greatx::scene::generator {

namespace {

/// A field. On each side of the road there are two bands of fields, each divided at its own rows.
struct Field {
  int row0, row1, column0, column1;  ///< cells [row0, row1) x [column0, column1)
  int material;
  double angle = 0.0;  ///< angle of the rows of its crop, rad
  dvec2 offset{0.0};   ///< offset of its texture
};

class Country {
 public:
  Country(SceneWriter& writer, double size_m, uint64_t seed, Season season)
      : writer_(writer), seed_(seed), season_(season), random_(seed, 5), terrain_(size_m, random_) {}

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
    add_verges();
  }

 private:
  dvec2 find_pond();
  void choose_sites();
  /// Returns the fields of a band that are not for crops, in order of rows.
  std::vector<Field> reserved(const std::array<int, 2>& band) const;
  double wood_radius() const { return std::min(0.2 * terrain_.half(), 26.0); }
  void choose_fields();
  void add_ground();
  void add_hedges();
  void add_farms();
  void add_woods();
  void add_poles();
  void add_lamps();
  void add_verges();
  void add_yard(size_t farm);
  void add_tree(const dvec2& where, bool conifer);
  void add_fallen(const dvec2& where, int kind);
  bool near_site(const dvec2& point, double margin) const;
  int shared(const std::string& name, const std::function<MeshBuilder()>& make);
  void add(const std::string& name, const MeshBuilder& mesh, SemanticClass semantic_class) {
    writer_.add_node({.name = name, .mesh = writer_.add_mesh(name, mesh), .semantic_class = semantic_class});
  }

  SceneWriter& writer_;
  uint64_t seed_;
  Season season_;
  RandomStream random_;
  Terrain terrain_;
  std::vector<Site> farms_;
  Site pond_;
  std::vector<dvec2> woods_;
  std::vector<Field> fields_;
  std::map<std::string, int> meshes_;
  int tree_count_ = 0;
};

// These functions choose the sites and the fields, and lay the ground.

bool Country::near_site(const dvec2& point, double margin) const {
  for (const Site& farm : farms_)
    if (glm::length(point - farm.center) < farm.inner_m + margin) return true;
  return glm::length(point - pond_.center) < pond_.outer_m + margin ||
         std::abs(point.y - terrain_.road_y(point.x)) < road_half_width_m + verge_m + margin;
}

dvec2 Country::find_pond() {
  // Of random places take the first that is clear of road and farms, or else the one with the most room.
  const double limit = terrain_.half() - pond_.outer_m - 4.0;
  dvec2 best(0.0);
  double best_room = -1e9;
  for (int attempt = 0; attempt < 100 && best_room < 0.0; ++attempt) {
    const double x = random_.uniform(-limit, limit), y = random_.uniform(-limit, limit);
    const dvec2 center = snap(dvec2(x, y));
    double room = 1e9;
    for (double along = -pond_.outer_m; along <= pond_.outer_m; along += 4.0) {
      const dvec2 road(x + along, terrain_.road_y(x + along));
      room = std::min(room, glm::length(center - road) - pond_.outer_m - road_half_width_m - verge_m);
    }
    for (const Site& farm : farms_)
      room = std::min(room, glm::length(center - farm.center) - pond_.outer_m - farm.inner_m - 4.0);
    if (room > best_room) {
      best_room = room;
      best = center;
    }
  }
  return best;
}

void Country::choose_sites() {
  // There is a farm on each side of the road, and a pond away from both.
  const double half = terrain_.half();
  const auto beside_road = [&](double x, double distance, double side) {
    const dvec2 along = terrain_.road_direction(x);
    return snap(dvec2(x, terrain_.road_y(x)) + side * distance * dvec2(-along.y, along.x));
  };
  const double side = random_.uniform() < 0.5 ? 1.0 : -1.0;
  const double reach = std::min(0.5 * half, 110.0);
  const double yard = std::min(24.0, 0.3 * half);
  for (const double sign : {-1.0, 1.0}) {
    Site farm;
    farm.center = beside_road(sign * reach * random_.uniform(0.55, 0.75), yard + 10.0, sign * side);
    farm.inner_m = yard;
    farm.outer_m = yard + 16.0;
    farm.level = snap(terrain_.height(farm.center));
    farms_.push_back(farm);
  }
  for (const Site& farm : farms_) terrain_.flatten(farm);
  pond_.inner_m = std::min(9.0, 0.1 * half);
  pond_.outer_m = 3.2 * pond_.inner_m;
  pond_.center = find_pond();
  double shore = 1e9;
  for (const dvec2& p : regular_polygon(24, pond_.outer_m, pond_.center))
    shore = std::min(shore, terrain_.height(p));
  pond_.level = snap(shore - 3.0);  // the level of the bed; the water stands 1.7 m above it
  terrain_.flatten(pond_);
  for (const double sign : {-1.0, 1.0})
    woods_.emplace_back(random_.uniform(-0.75, 0.75) * half, sign * 0.72 * half);
}

std::vector<Field> Country::reserved(const std::array<int, 2>& band) const {
  std::vector<Field> fields;
  const double step = terrain_.vertex(1, 0).x - terrain_.vertex(0, 0).x;
  const auto reserve = [&](const dvec2& center, double reach, const char* name) {
    const auto row_at = [&](double x) {
      return std::clamp(static_cast<int>(std::lround((x + terrain_.half()) / step)), 0, terrain_.rows() - 1);
    };
    const int middle = row_at(center.x);
    if (center.y < terrain_.vertex(middle, band[0]).y || center.y >= terrain_.vertex(middle, band[1]).y)
      return;
    const Field field{row_at(center.x - reach), row_at(center.x + reach), band[0], band[1], material(name)};
    if (field.row1 > field.row0) fields.push_back(field);
  };
  for (const Site& farm : farms_) reserve(farm.center, farm.inner_m + 5.0, "grass");
  reserve(pond_.center, pond_.outer_m + 5.0, "meadow");
  for (const dvec2& wood : woods_) reserve(wood, 1.2 * wood_radius(), "meadow");
  std::sort(fields.begin(), fields.end(), [](const Field& a, const Field& b) { return a.row0 < b.row0; });
  return fields;
}

void Country::choose_fields() {
  const std::array<const char*, 10> crops{"wheat",      "crop",    "ploughed_soil", "rapeseed", "crop_young",
                                          "wheat_pale", "stubble", "crop_dark",     "crop",     "wheat"};
  const int south = terrain_.road_south() - 1, north = terrain_.road_north() + 1,
            last = terrain_.columns() - 1;
  const std::array<std::array<int, 2>, 4> bands{
      {{0, south / 2}, {south / 2, south}, {north, (north + last) / 2}, {(north + last) / 2, last}}};
  const int rows = terrain_.rows() - 1;
  for (const auto& band : bands) {
    int before = -1, row = 0;
    const auto fill = [&](int until) {  // with crops, no two alike side by side
      while (row < until) {
        int end = std::min(row + 6 + static_cast<int>(random_.below(6)), until);
        if (until - end < 4) end = until;
        size_t pick = random_.below(static_cast<uint32_t>(crops.size()));
        while (material(crops[pick]) == before) pick = (pick + 1) % crops.size();
        before = material(crops[pick]);
        fields_.push_back({row, end, band[0], band[1], before, random_.uniform(0.0, pi),
                           dvec2(random_.uniform(), random_.uniform())});
        row = end;
      }
    };
    // Yards, the banks of the pond and woods stand on grass.
    for (const Field& field : reserved(band)) {
      fill(field.row0);
      if (field.row1 <= row) continue;
      fields_.push_back({row, field.row1, band[0], band[1], field.material});
      row = field.row1;
    }
    fill(rows);
  }
}

void Country::add_ground() {
  const int verge = material("verge"), meadow = material("meadow");
  const int south = terrain_.road_south(), north = terrain_.road_north();
  MeshBuilder land, road, water;
  terrain_.add_surface(land, [&](int row, int column) {
    if (column == south) return Terrain::Cover{};
    if (column == south - 1 || column == north) return Terrain::Cover{.material = verge};
    for (const Field& f : fields_)
      if (row >= f.row0 && row < f.row1 && column >= f.column0 && column < f.column1)
        return Terrain::Cover{.material = f.material, .angle = f.angle, .offset = f.offset};
    return Terrain::Cover{.material = meadow};
  });
  terrain_.add_base(land);
  terrain_.add_surface(road, [&](int, int column) {
    return column == south ? Terrain::Cover{.material = material("country_road"), .along_road = true}
                           : Terrain::Cover{};
  });
  // The water is a disc that reaches into the banks all around. The shore is where disc and banks meet.
  water.flat_polygon(material("water"), regular_polygon(20, 0.9 * pond_.outer_m, pond_.center),
                     pond_.level + 1.7, true);
  add("terrain", land, SemanticClass::ground);
  add("road", road, SemanticClass::road);
  add("pond", water, SemanticClass::water);
}

// These functions add hedges, trees, farms, poles and lamps.

int Country::shared(const std::string& name, const std::function<MeshBuilder()>& make) {
  const auto found = meshes_.find(name);
  if (found != meshes_.end()) return found->second;
  return meshes_[name] = writer_.add_mesh(name, make());
}

void Country::add_hedges() {
  int count = 0;
  for (const Field& field : fields_) {
    if (field.row0 == 0 || random_.uniform() < 0.15) continue;
    std::vector<dvec3> chain;
    const auto flush = [&] {
      if (chain.size() > 2) {
        add(fmt::format("hedge_{:03}", count), make_hedge(chain, 1300u + static_cast<uint32_t>(count)),
            SemanticClass::vegetation);
        ++count;
      }
      chain.clear();
    };
    const int from = std::max(field.column0, 1), to = std::min(field.column1, terrain_.columns() - 2);
    for (int column = from; column <= to; ++column) {
      const dvec3 p = terrain_.vertex(field.row0, column);
      // The last station of a hedge lies a quarter of a step before the hedge of the next band.
      if (near_site(dvec2(p), 5.0)) {
        flush();
        continue;
      }
      chain.push_back(
          column == to && to == field.column1 ? glm::mix(p, chain.empty() ? p : chain.back(), 0.25) : p);
      if (column < to && random_.uniform() < 0.3)
        add_tree(dvec2(p) + dvec2(2.4, random_.uniform(-3.0, 3.0)), false);
    }
    flush();
  }
}

void Country::add_tree(const dvec2& where, bool conifer) {
  const dvec2 at = snap(where);
  if (std::max(std::abs(at.x), std::abs(at.y)) > terrain_.half() - 3.0 || near_site(at, 3.0)) return;
  // Most trees are oaks, maples and lindens. Poplars and copper beeches are rare.
  static constexpr std::array<int, 12> kinds{2, 2, 1, 0, 2, 3, 1, 2, 4, 0, 3, 5};
  const int kind = kinds[random_.below(kinds.size())], shape = static_cast<int>(random_.below(2));
  const int mesh = conifer ? shared("conifer", [] { return make_conifer(); })
                           : shared(fmt::format("tree_{}_{}", kind, shape),
                                    [&] { return make_tree(kind, shape, 0.0, season_); });
  if (season_ == Season::autumn && !conifer) add_fallen(at, kind);
  writer_.add_node({.name = fmt::format("tree_{:03}", tree_count_++),
                    .mesh = mesh,
                    .position = dvec3(at, terrain_.height(at) - 0.1),
                    .yaw = random_.uniform(0.0, 2.0 * pi),
                    .scale = random_.uniform(0.85, 1.5),
                    .semantic_class = SemanticClass::vegetation});
}

/// Adds leaves around a tree, a few centimetres over the ground.
void Country::add_fallen(const dvec2& where, int kind) {
  MeshBuilder mesh;
  uint32_t draw = static_cast<uint32_t>(tree_count_);
  for (const dvec2& middle : {dvec2(1.1, 0.7), dvec2(-1.0, 1.0), dvec2(0.1, -1.2)}) {
    std::array<dvec3, 4> corners;
    for (size_t i = 0; i < 4; ++i) {
      const dvec2 p = snap(where + middle + 1.4 * dvec2(i == 0 || i == 3 ? -1.0 : 1.0, i < 2 ? -1.0 : 1.0));
      corners[i] = dvec3(p, terrain_.height(p) + 0.02 +
                                0.003 * ((7u * static_cast<uint32_t>(tree_count_) + 5u * draw) % 17u));
    }
    add_fallen_leaves(mesh, kind, corners, draw++);
  }
  add(fmt::format("leaves_{:03}", tree_count_), mesh, SemanticClass::vegetation);
}

void Country::add_farms() {
  int building = 0;
  for (size_t f = 0; f < farms_.size(); ++f) {
    const Site& farm = farms_[f];
    const dvec2 along = terrain_.road_direction(farm.center.x), across(-along.y, along.x);
    const double yaw = std::atan2(along.y, along.x) + random_.uniform(-0.08, 0.08);
    const double scale = farm.inner_m / 24.0;
    const auto place = [&](const MeshBuilder& mesh, const std::string& kind, const dvec2& where,
                           double turn) {
      const std::string name = fmt::format("{}_{:03}", kind, building++);
      const dvec2 at = farm.center + scale * (where.x * along + where.y * across);
      writer_.add_node({.name = name,
                        .mesh = writer_.add_mesh(name, mesh),
                        .position = dvec3(at, farm.level),
                        .yaw = yaw + turn,
                        .semantic_class = SemanticClass::building});
    };
    place(make_farmhouse(scale), "farmhouse", {-12.0, -9.0}, pi / 2);
    place(make_barn(scale, random_.uniform() < 0.6), "barn", {10.0, 3.0}, 0.0);
    if (random_.uniform() < 0.6) place(make_barn(0.72 * scale, false), "barn", {-9.0, 12.0}, pi / 2);
    if (f == 0) place(make_silo(scale), "silo", {18.5, -8.0}, 0.0);
    const dvec2 at = farm.center + scale * (-1.5 * along - 7.0 * across);
    const bool van = f == 1;
    const int mesh = shared(van ? "parked_van" : "parked_car", [&] {
      return van ? make_parked_car("van", "car_paint_white") : make_parked_car("estate", "car_paint_blue");
    });
    writer_.add_node({.name = fmt::format("car_{:03}", f),
                      .mesh = mesh,
                      .position = dvec3(at, farm.level),
                      .yaw = yaw + random_.uniform(-0.6, 0.6),
                      .semantic_class = SemanticClass::vehicle});
    add_yard(f);
    // a few trees around the yard
    for (int i = 0; i < 5; ++i) {
      const double angle = random_.uniform(0.0, 2.0 * pi);
      add_tree(
          farm.center + (farm.inner_m + random_.uniform(4.0, 9.0)) * dvec2(std::cos(angle), std::sin(angle)),
          false);
    }
  }
}

void Country::add_woods() {
  for (size_t wood = 0; wood < woods_.size(); ++wood) {
    const dvec2 center = woods_[wood];
    for (int i = 0; i < 34; ++i) {
      const double angle = random_.uniform(0.0, 2.0 * pi), r = wood_radius() * std::sqrt(random_.uniform());
      add_tree(center + r * dvec2(1.5 * std::cos(angle), std::sin(angle)),
               (static_cast<size_t>(i) + wood) % 2 == 0);
    }
  }
  for (int i = 0; i < 9; ++i) {  // around the pond
    const double angle = 2.0 * pi * (i + random_.uniform(0.0, 0.7)) / 9;
    add_tree(pond_.center + (pond_.outer_m + 4.0) * dvec2(std::cos(angle), std::sin(angle)), false);
  }
}

void Country::add_poles() {
  std::vector<dvec3> tops;  // ends of the wires, to the left and right of each pole
  int count = 0;
  for (double x = -terrain_.half() + 15.0; x < terrain_.half() - 5.0; x += 38.0) {
    const dvec2 along = terrain_.road_direction(x), side(-along.y, along.x);
    const dvec2 at = snap(dvec2(x, terrain_.road_y(x)) + (road_half_width_m + verge_m - 0.4) * side);
    const double z = terrain_.height(at);
    writer_.add_node({.name = fmt::format("pole_{:03}", count++),
                      .mesh = shared("telegraph_pole", make_pole),
                      .position = dvec3(at, z),
                      .yaw = std::atan2(along.y, along.x),
                      .semantic_class = SemanticClass::pole});
    for (const double arm : {-pole_wire_y_m, pole_wire_y_m})
      tops.emplace_back(at + arm * side, snap(z) + pole_wire_z_m);
  }
  for (size_t i = 2; i < tops.size(); i += 2) {
    MeshBuilder wires;
    for (const size_t arm : {size_t{0}, size_t{1}})
      add_wire(wires, material("wire"), hanging_wire(tops[i - 2 + arm], tops[i + arm], 0.7, 8), 0.02);
    add(fmt::format("wires_{:03}", i / 2 - 1), wires, SemanticClass::pole);
  }
}

void Country::add_lamps() {
  int light = -1, count = 0;
  const auto lamp = [&](LampKind kind, const dvec2& where, double z, double yaw) {
    const Lamp made = make_lamp(kind);
    if (light < 0) light = writer_.add_light(made.light);
    const std::string name = fmt::format("lamp_{:03}", count++);
    const int node = writer_.add_node(
        {.name = name,
         .mesh = shared(fmt::format("lamp_{}", static_cast<int>(kind)), [&] { return made.mesh; }),
         .position = dvec3(snap(where), z),
         .yaw = yaw,
         .semantic_class = SemanticClass::street_lamp});
    writer_.add_node({.name = name + "_light",
                      .position = made.light_position,
                      .parent = node,
                      .light = light,
                      .shine = {0.0, 0.0, -1.0}});
  };
  for (const Site& farm : farms_) {
    const double scale = farm.inner_m / 24.0;
    const dvec2 along = terrain_.road_direction(farm.center.x), across(-along.y, along.x);
    for (const dvec2& at : {dvec2(-2.0, 1.0), dvec2(4.0, -9.0)})
      lamp(LampKind::yard, farm.center + scale * (at.x * along + at.y * across), farm.level, 0.7);
    // Lamps also stand along the lane past the yard, on the side without poles.
    for (const double shift : {-30.0, 0.0, 30.0}) {
      const double x = farm.center.x + scale * shift;
      const dvec2 direction = terrain_.road_direction(x), side(-direction.y, direction.x);
      const dvec2 at = dvec2(x, terrain_.road_y(x)) - (road_half_width_m + 0.9) * side;
      lamp(LampKind::yard, at, terrain_.height(snap(at)) - 0.05, std::atan2(side.y, side.x));
    }
  }
}

/// Adds what stands about in the yard of a farm. It has random numbers of its own.
void Country::add_yard(size_t number) {
  const Site& farm = farms_[number];
  RandomStream random(seed_, 8, static_cast<uint32_t>(number));
  const double scale = farm.inner_m / 24.0;
  if (scale < 0.9) return;  // the yards of small models are full
  const dvec2 along = terrain_.road_direction(farm.center.x), across(-along.y, along.x);
  const double heading = std::atan2(along.y, along.x);
  int count = 0;
  const auto place = [&](const std::string& name, const std::function<MeshBuilder()>& make, const dvec2& at,
                         double turn) {
    writer_.add_node({.name = fmt::format("{}_{}{:02}", name, number, count++),
                      .mesh = shared(name, make),
                      .position = dvec3(farm.center + scale * (at.x * along + at.y * across), farm.level),
                      .yaw = heading + turn,
                      .semantic_class = SemanticClass::furniture});
  };
  for (int i = 0; i < 7; ++i)
    place("bale", make_bale, {17.2 + 1.5 * (i % 3) + 0.2 * random.uniform(), 9.0 + 1.6 * (i / 3)},
          random.uniform(-0.2, 0.2));
  place("trailer", make_trailer, {9.0 + random.uniform(-1.0, 1.0), -13.5}, random.uniform(-0.4, 0.4));
  for (const double x : {-12.0, -2.2})
    place(
        "fence", [] { return make_rail_fence(9.6); }, {x, 20.0}, 0.0);
}

/// Adds grass along both sides of the road, in pieces of 30 m. It has random numbers of its own.
void Country::add_verges() {
  RandomStream random(seed_, 7);
  int count = 0;
  std::vector<dvec3> feet;
  const auto flush = [&] {
    if (!feet.empty())
      add(fmt::format("grass_{:03}", count), make_grass(feet, 1500u + static_cast<uint32_t>(count)),
          SemanticClass::vegetation);
    ++count;
    feet.clear();
  };
  for (const double side : {-1.0, 1.0}) {
    double next = -terrain_.half() + 30.0;
    for (double x = -terrain_.half() + 1.0; x < terrain_.half() - 1.0; x += random.uniform(0.5, 1.9)) {
      const dvec2 along = terrain_.road_direction(x), out(-along.y, along.x);
      const double from = road_half_width_m + random.uniform(0.25, verge_m + 1.6);
      const dvec2 at = snap(dvec2(x, terrain_.road_y(x)) + side * from * out);
      if (std::abs(at.y) > terrain_.half() - 1.0 || std::abs(at.x) > terrain_.half() - 1.0) continue;
      feet.emplace_back(at, terrain_.height(at));
      if (x < next) continue;
      flush();
      next += 30.0;
    }
    flush();
  }
}

}  // namespace

void write_country(SceneWriter& writer, double size_m, uint64_t seed, Season season) {
  Country(writer, size_m, seed, season).write();
}

}  // namespace greatx::scene::generator
