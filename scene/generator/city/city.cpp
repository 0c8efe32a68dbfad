// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "scene/generator/city/city.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <map>
#include <string>

#include <fmt/format.h>

#include "core/units.h"
#include "scene/generator/city/city_buildings.h"
#include "scene/generator/city/city_ground.h"
#include "scene/generator/city/city_network.h"
#include "scene/generator/city/city_street.h"
#include "scene/generator/mesh/materials.h"
#include "scene/generator/objects/objects.h"
#include "scene/generator/objects/street_furniture.h"
#include "scene/generator/objects/street_pieces.h"
#include "scene/generator/objects/trees.h"
#include "scene/generator/objects/vehicles.h"
#include "scene/generator/paint/texture_painter.h"

namespace greatx::scene::generator {

namespace {

/// Lowest part of the crown of a tree at a street, m. It keeps 4.6 m above the street free, even if the tree
/// is scaled down.
constexpr double street_crown_m = 5.3;

/// Holds the meshes that many nodes share, and the running numbers in the names of the nodes.
class CityFurniture {
 public:
  CityFurniture(SceneWriter& writer, Season season) : writer_(writer), season_(season) {}

  /// `kind` is as in make_tree. A tree at a street leaves room for lorries below its crown.
  void tree(const dvec2& where, double z, int kind, bool at_street, RandomStream& random) {
    const int shape = static_cast<int>(random.below(4)) % 2;
    const std::string name = fmt::format("{}_{}_{}", at_street ? "street_tree" : "tree", kind, shape);
    const int mesh =
        shared(name, [&] { return make_tree(kind, shape, at_street ? street_crown_m : 0.0, season_); });
    const double draw = random.uniform(), yaw = random.uniform(0.0, 2.0 * pi);
    const double scale = at_street ? 0.95 + 0.2 * draw : 0.85 + 0.45 * draw;
    writer_.add_node({.name = number("tree"),
                      .mesh = mesh,
                      .position = dvec3(where, z),
                      .yaw = yaw,
                      .scale = scale,
                      .semantic_class = SemanticClass::vegetation});
  }
  /// Leaves lie around a tree in autumn: `half` m to both sides of `where` along `along` and across it, at
  /// height z.
  void fallen_leaves(const dvec2& where, double z, int kind, const dvec2& along, const dvec2& half) {
    if (season_ != Season::autumn) return;
    const dvec2 u = half.x * along, v = half.y * dvec2(-along.y, along.x);
    MeshBuilder mesh;
    const std::string name = number("leaves");
    add_fallen_leaves(
        mesh, kind,
        {dvec3(where - u - v, z), dvec3(where + u - v, z), dvec3(where + u + v, z), dvec3(where - u + v, z)},
        static_cast<uint32_t>(counts_["leaves"]));
    writer_.add_node(
        {.name = name, .mesh = writer_.add_mesh(name, mesh), .semantic_class = SemanticClass::vegetation});
  }
  void lamp(LampKind kind, const dvec2& where, double z, double yaw) {
    const Lamp lamp = make_lamp(kind);
    const auto key = static_cast<size_t>(kind);
    if (lights_[key] < 0) lights_[key] = writer_.add_light(lamp.light);
    const std::string name = number("lamp");
    const int node =
        writer_.add_node({.name = name,
                          .mesh = shared(fmt::format("street_lamp_{}", key), [&] { return lamp.mesh; }),
                          .position = dvec3(where, z),
                          .yaw = yaw,
                          .semantic_class = SemanticClass::street_lamp});
    writer_.add_node({.name = name + "_light",
                      .position = lamp.light_position,
                      .parent = node,
                      .light = lights_[key],
                      .shine = {0.0, 0.0, -1.0}});
  }
  void car(const dvec2& where, double yaw, RandomStream& random) {
    static constexpr std::array<const char*, 13> kinds{
        "hatchback", "compact", "saloon",    "estate", "suv",       "mini", "mpv",
        "coupe",     "compact", "hatchback", "van",    "panel_van", "suv"};
    static constexpr std::array<const char*, 5> paints{"white", "silver", "grey", "black", "blue"};
    static constexpr std::array<const char*, 4> rare{"red", "navy", "bronze", "green"};
    const uint32_t kind = random.below(13);
    const std::string variant = kinds[kind];
    // Few paints for every body, so that the cars of a city share meshes.
    const bool common = random.below(3) > 0;
    const bool van = variant == "van" || variant == "panel_van";
    const std::string paint = van ? "white" : common ? paints[kind % 5] : rare[kind % 4];
    place(
        "car", fmt::format("parked_{}_{}", variant, paint),
        [&] { return make_parked_car(variant, "car_paint_" + paint); }, dvec3(where, 0.0), yaw,
        SemanticClass::vehicle);
  }
  void bench(const dvec2& where, double z, double yaw) {
    place("bench", "bench", make_bench, dvec3(where, z), yaw, SemanticClass::furniture);
  }
  void signal(const dvec2& where, double yaw, uint32_t junction, uint32_t group) {
    const std::string node =
        place("signal", "signal", make_signal, dvec3(where, pavement_height_m), yaw, SemanticClass::pole);
    signals_.push_back({node, junction, group, false});
  }
  void walk_signal(const dvec2& where, double yaw, uint32_t junction, uint32_t group, bool pole) {
    const std::string node = place(
        "walk_signal", pole ? "walk_signal_pole" : "walk_signal", [&] { return make_walk_signal(pole); },
        dvec3(where, pavement_height_m), yaw, SemanticClass::pole);
    signals_.push_back({node, junction, group, true});
  }
  std::vector<StreetSignal> signals() const { return signals_; }
  void sign(SignKind kind, const dvec2& where, double yaw) {
    place(
        "sign", fmt::format("sign_{}", static_cast<int>(kind)), [&] { return make_traffic_sign(kind); },
        dvec3(where, pavement_height_m), yaw, SemanticClass::pole);
  }
  void stop_pole(const dvec2& where, double yaw) {
    place("stop_pole", "stop_pole", make_stop_pole, dvec3(where, pavement_height_m), yaw,
          SemanticClass::pole);
  }
  void site_fence(const dvec2& where, double yaw) {
    place("site_fence", "site_fence", make_site_fence, dvec3(where, pavement_height_m), yaw,
          SemanticClass::furniture);
  }
  void shelter(const dvec2& where, double yaw) {
    place("shelter", "shelter", make_shelter, dvec3(where, pavement_height_m), yaw, SemanticClass::furniture);
  }
  void bin(const dvec2& where) {
    place("bin", "bin", make_bin, dvec3(where, pavement_height_m), 0.0, SemanticClass::furniture);
  }

 private:
  int shared(const std::string& name, const std::function<MeshBuilder()>& make) {
    const auto found = meshes_.find(name);
    if (found != meshes_.end()) return found->second;
    return meshes_[name] = writer_.add_mesh(name, make());
  }
  std::string number(const std::string& name) { return fmt::format("{}_{:03}", name, counts_[name]++); }
  std::string place(const std::string& name, const std::string& mesh,
                    const std::function<MeshBuilder()>& make, const dvec3& where, double yaw,
                    SemanticClass semantic_class) {
    std::string node = number(name);
    writer_.add_node({.name = node,
                      .mesh = shared(mesh, make),
                      .position = where,
                      .yaw = yaw,
                      .semantic_class = semantic_class});
    return node;
  }

  SceneWriter& writer_;
  Season season_;
  std::map<std::string, int> meshes_, counts_;
  std::array<int, 4> lights_{-1, -1, -1, -1};  ///< by LampKind
  std::vector<StreetSignal> signals_;
};

double heading(const dvec2& direction) { return std::atan2(direction.y, direction.x); }

/// Places the signals along an edge, where a street meets a junction with signals: heads for drivers, who
/// come from the edge's end, beyond the zebra, and heads for people at both ends of the zebras, which look
/// over the street. Returns the places of their poles, m along the edge.
std::vector<double> add_signals(const CityPlan& plan, const Block& block, int edge, CityFurniture& furniture,
                                const std::vector<double>& taken) {
  constexpr double from_end_m = 4.0, depth_m = 0.45, room_m = 0.8;
  const Kerb kerb(block, edge);
  std::vector<double> poles;
  for (const bool start : {true, false}) {
    const EdgeEnd end = edge_end(plan, block, edge, start);
    if (!end.junction || (!start && !end.zebra)) continue;
    double from = from_end_m;
    while (std::ranges::any_of(
        taken, [&](double t) { return std::abs(t - (start ? from : kerb.length - from)) <= room_m; }))
      from += 0.4;
    const double at = start ? from : kerb.length - from;
    const dvec2 where = kerb.spot(at, depth_m);
    if (start) furniture.signal(where, heading(kerb.along), *end.junction, end.group);
    if (end.zebra) furniture.walk_signal(where, heading(-kerb.inwards), *end.junction, end.group, !start);
    poles.push_back(at);
  }
  return poles;
}

/// Places the furniture of a block's pavements. Lamps stand about every 34 m along both sides of an avenue,
/// staggered, and about every 30 m along the south and west edges of other blocks, so that each street has
/// one row. Trees of one species stand along avenues. There are also signals, signs, shelters and bins.
/// Returns the places that these take.
TakenPlaces furnish_pavement(const CityPlan& plan, const Block& block, uint64_t seed,
                             CityFurniture& furniture, CityStreet& street, RandomStream& random) {
  TakenPlaces all;
  for (int edge = 0; edge < 4; ++edge) {
    if (!block.street[static_cast<size_t>(edge)]) continue;
    const Kerb kerb(block, edge);
    const double length = kerb.length;
    const dvec2 along = kerb.along, inwards = kerb.inwards;
    const bool avenue = kerb.avenue;
    std::vector<double>& taken = all[static_cast<size_t>(edge)];
    const auto free = [&](double at, double room) {
      return std::all_of(taken.begin(), taken.end(), [&](double t) { return std::abs(t - at) > room; });
    };
    const auto spot = [&](double at, double depth) { return kerb.spot(at, depth); };
    if (avenue || edge == 0 || edge == 3) {
      const int lamps = std::max(1, static_cast<int>(std::lround(length / (avenue ? 34.0 : 30.0))));
      const double phase = avenue && (edge == 1 || edge == 2) ? 0.85 : 0.35;
      for (int i = 0; i < lamps; ++i) {
        const double at = std::clamp(length * (i + phase) / lamps, 1.2, length - 1.2);
        furniture.lamp(avenue ? LampKind::avenue : LampKind::street, spot(at, 0.7), pavement_height_m,
                       heading(-inwards));
        taken.push_back(at);
      }
    }
    // Drivers beside this pavement come from b. Signals and signs for them therefore stand near a and face
    // along the edge.
    const bool crossing = block.street[static_cast<size_t>((edge + 3) % 4)];
    const std::vector<double> poles = add_signals(plan, block, edge, furniture, taken);
    if (!poles.empty() && poles.front() < 0.5 * length) {
      taken.push_back(poles.front());
    } else if (crossing && edge % 2 == 0 && free(4.4, 0.8)) {
      furniture.sign(SignKind::crossing, spot(4.4, 0.45), heading(along));
    }
    // Drivers who come from a street wait for those on the avenue.
    const bool meets_avenue = crossing && block.pavement_m[static_cast<size_t>((edge + 3) % 4)] >= 4.0;
    if (!avenue && meets_avenue && free(5.6, 0.8)) {
      const bool stop = hash(block.column + edge, block.row, static_cast<uint32_t>(seed) + 5) % 2 == 0;
      furniture.sign(stop ? SignKind::stop : SignKind::yield, spot(5.6, 0.45), heading(along));
      taken.push_back(5.6);
    }
    const uint32_t dice = hash(block.column * 4 + edge, block.row, static_cast<uint32_t>(seed));
    if (avenue && length > 40.0 && dice % 3 == 0) {
      const double at = 0.62 * length;
      furniture.shelter(spot(at, 2.4), heading(-inwards));
      for (const double side : {-4.0, -2.0, 0.0, 2.0, 4.0}) taken.push_back(at + side);
      furniture.bin(spot(at + 3.2, 2.2));
      furniture.stop_pole(spot(at - 3.0, 0.5), heading(along));
    }
    const int slots = std::max(2, static_cast<int>(length / 10.5));
    const int kind =
        static_cast<int>(hash(edge % 2, 7, static_cast<uint32_t>(seed)) % 2) * 3;  // linden or plane
    for (int i = 0; avenue && i < slots; ++i) {
      const double at = length * (i + 0.5) / slots;
      if (!free(at, 2.6) || at <= 5.0) continue;
      furniture.tree(spot(at, 1.2), pavement_height_m, kind, true, random);
      street.grate(spot(at, 1.2), heading(along));
      // On the pavement, and in the gutter.
      furniture.fallen_leaves(spot(at, 2.3), pavement_height_m + 0.02, kind, along, {1.7, 1.3});
      furniture.fallen_leaves(spot(at + 0.8, -0.45), 0.01, kind, along, {2.6, 0.42});
      taken.push_back(at);
    }
    taken.insert(taken.end(), poles.begin(), poles.end());
  }
  return all;
}

void park_cars(const CityPlan& plan, CityFurniture& furniture, RandomStream& random) {
  for (const Street& street : plan.streets) {
    if (street.avenue) continue;
    const double length = glm::length(street.right[1] - street.right[0]);
    const dvec2 along = (street.right[1] - street.right[0]) / length, left(-along.y, along.x);
    const int slots = static_cast<int>((length - 16.0) / 6.2);
    for (int i = 0; i < slots; ++i) {
      if (random.uniform() > 0.2) continue;
      const dvec2 spot = street.right[0] + along * (9.0 + 6.2 * i + random.uniform(-0.3, 0.3)) + left * 1.25;
      furniture.car(spot, heading(along), random);
    }
  }
}

/// Adds grass that stands higher than the lawn: around the trees' feet and along the paths. A tuft has four
/// triangles; there are at most `most_tufts`.
void add_park_grass(SceneWriter& writer, const std::vector<dvec2>& trees, const dvec2& center,
                    const std::vector<dvec2>& path_ends, RandomStream& random) {
  constexpr size_t most_tufts = 150;
  std::vector<dvec3> feet;
  const auto add = [&](const dvec2& at) {
    if (feet.size() < most_tufts && glm::length(at - center) > 8.8)
      feet.emplace_back(snap(at), pavement_height_m);
  };
  for (const dvec2& tree : trees)
    for (int i = 0; i < 3; ++i) {
      const double angle = random.uniform(0.0, 2.0 * pi), far = random.uniform(0.35, 0.9);
      add(tree + far * dvec2(std::cos(angle), std::sin(angle)));
    }
  for (const dvec2& end : path_ends) {
    const dvec2 along = glm::normalize(end - center), side(-along.y, along.x);
    for (double at = 9.0; at < glm::length(end - center); at += random.uniform(1.2, 4.5))
      add(center + at * along + (random.uniform() < 0.5 ? 1.0 : -1.0) * random.uniform(1.75, 2.3) * side);
  }
  writer.add_node({.name = "grass_000",
                   .mesh = writer.add_mesh("grass_000", make_grass(feet, 1700)),
                   .semantic_class = SemanticClass::vegetation});
}

/// Adds a lawn with paths, trees and benches around a small plaza with a fountain.
void add_park(SceneWriter& writer, const Block& block, uint64_t seed, CityFurniture& furniture,
              RandomStream& random) {
  const std::vector<dvec2> quad = inset(block.sharp, block.pavement_m);
  const auto at = [&](double u, double v) {
    return glm::mix(glm::mix(quad[0], quad[1], u), glm::mix(quad[3], quad[2], u), v);
  };
  const dvec2 center = snap(at(0.5, 0.5));
  const double z = pavement_height_m;
  MeshBuilder paths;
  const int paving = material("paving");
  for (const dvec2& end : {at(0.5, 0.03), at(0.97, 0.5), at(0.5, 0.97), at(0.03, 0.5)}) {
    const dvec2 along = glm::normalize(end - center), side(-along.y * 1.4, along.x * 1.4);
    const dvec2 start = center + along * 6.5;
    const std::vector<dvec2> strip{snap(start - side), snap(end - side), snap(end + side),
                                   snap(start + side)};
    paths.prism(paving, paving, strip, z - 0.10, z + 0.03);
  }
  paths.prism(paving, paving, regular_polygon(12, 8.0, center, 0.2), z - 0.13, z + 0.06);
  writer.add_node({.name = "park_paths",
                   .mesh = writer.add_mesh("park_paths", paths),
                   .semantic_class = SemanticClass::pavement});

  MeshBuilder fountain;
  const int stone = material("concrete");
  RingSolid basin{
      regular_polygon(8, 2.6),
      {{0.0, -0.1, stone}, {0.0, 0.6, stone}, {0.35, 0.6, stone}, {0.35, 0.42, material("water")}},
      stone,
      {}};
  add_ring_solid(fountain, basin);
  fountain.prism(stone, stone, regular_polygon(6, 0.4), 0.1, 1.7);
  writer.add_node({.name = "fountain",
                   .mesh = writer.add_mesh("fountain", fountain),
                   .position = dvec3(center, z + 0.06),
                   .semantic_class = SemanticClass::furniture});

  std::vector<dvec2> trees;
  for (int i = 0; i < 5; ++i)
    for (int j = 0; j < 5; ++j) {
      if (i == 2 || j == 2) continue;
      const double u = 0.1 + 0.2 * i + random.uniform(-0.045, 0.045);
      const double v = 0.1 + 0.2 * j + random.uniform(-0.045, 0.045);
      const int kind = static_cast<int>(hash(i, j, 77) % tree_species);
      furniture.tree(at(u, v), z, kind, false, random);
      trees.push_back(at(u, v));
      for (const dvec2& side : {dvec2(1.1, 0.6), dvec2(-0.9, 1.2), dvec2(0.2, -1.3)})
        furniture.fallen_leaves(at(u, v) + side, z + 0.015 + 0.002 * side.y, kind,
                                glm::normalize(dvec2(side.y, 1.0 + side.x)), {1.5, 1.4});
    }
  for (const dvec2& end : {at(0.5, 0.03), at(0.97, 0.5), at(0.5, 0.97), at(0.03, 0.5)}) {
    const dvec2 along = glm::normalize(end - center), side(-along.y, along.x);
    const double reach = glm::length(end - center);
    for (const double distance : {9.5, 0.5 * (9.5 + reach) + 3.0})
      if (distance < reach - 4.0)
        furniture.lamp(LampKind::park, snap(center + along * distance + side * 1.9), z, heading(-side));
  }
  for (int i = 0; i < 4; ++i) {
    const double angle = pi / 4 + pi / 2 * i;
    const dvec2 out(std::cos(angle), std::sin(angle));
    furniture.bench(center + 6.6 * out, z + 0.06, angle - pi / 2);
  }
  RandomStream grass(seed, 9);
  add_park_grass(writer, trees, center, {at(0.5, 0.03), at(0.97, 0.5), at(0.5, 0.97), at(0.03, 0.5)}, grass);
}

}  // namespace

std::span<const char* const> city_textures() {
  static constexpr const char* names[] = {
      // The dear ones come first, so that no core is left with one of them at the end.
      "facade_stone", "facade_plaster", "facade_brick",  "facade_balcony", "facade_concrete", "facade_ribbon",
      "facade_glass", "facade_metal",   "shopfront",     "asphalt",        "pavement",        "grass",
      "leaf_sprays",  "leaves",         "traffic_signs", "bicycles",       "column_bills",    "car_side",
      "plinth",       "roof",           "road_paint",    "dormer",         "poster",          "awning",
      "bark",         "bark_birch",     "bark_plane",    "boards",         "brick",           "concrete",
      "corrugated",   "kerb",           "roof_tiles",    "slate",          "solar",           "tree_grate",
      "wheel_alloy"};
  return names;
}

void write_city(SceneWriter& writer, double size_m, uint64_t seed, Season season) {
  writer.paint_ahead(city_textures());
  const CityPlan plan = plan_city(size_m, seed);
  const auto add = [&](const std::string& name, const MeshBuilder& mesh, SemanticClass semantic_class) {
    writer.add_node({.name = name, .mesh = writer.add_mesh(name, mesh), .semantic_class = semantic_class});
  };
  MeshBuilder base, road, markings;
  add_streets(plan, road, markings);
  add_base(plan, base);
  add("road", road, SemanticClass::road);
  add("lane_markings", markings, SemanticClass::lane_marking);
  add("ground_base", base, SemanticClass::ground);

  CityFurniture furniture(writer, season);
  CityStreet street(writer, seed);
  RandomStream random(seed, 3), details(seed, 4);
  const std::array<const char*, 4> surfaces{"paving", "grass", "asphalt_lot", "paving"};
  int building = 0;
  for (size_t i = 0; i < plan.block.size(); ++i) {
    const Block& block = plan.block[i];
    const bool park = block.column == plan.blocks / 2 && block.row == plan.blocks / 2;
    MeshBuilder pavement, courtyard;
    add_block_ground(block, material(park ? "grass" : surfaces[details.below(4)]), pavement, courtyard);
    add(fmt::format("pavement_{:03}", i), pavement, SemanticClass::pavement);
    add(fmt::format("{}_{:03}", park ? "park" : "courtyard", i), courtyard, SemanticClass::ground);
    street.furnish(block, furnish_pavement(plan, block, seed, furniture, street, details));
    if (park) {
      add_park(writer, block, seed, furniture, details);
      continue;
    }
    for (const Building& b : make_buildings(plan, block, seed, building, random)) {
      const std::string name = fmt::format("building_{:03}", building++);
      writer.add_node({.name = name,
                       .mesh = writer.add_mesh(name, b.mesh),
                       .position = b.position,
                       .yaw = b.yaw,
                       .semantic_class = SemanticClass::building});
      for (const CafePlace& cafe : b.cafes) street.cafe(cafe.where, cafe.out);
      if (b.scaffold.empty()) continue;
      writer.add_node({.name = name + "_scaffold",
                       .mesh = writer.add_mesh(name + "_scaffold", b.scaffold),
                       .position = b.position,
                       .yaw = b.yaw,
                       .semantic_class = SemanticClass::furniture});
      for (const CafePlace& fence : b.fences)
        furniture.site_fence(fence.where, heading(fence.out) - 0.5 * pi);
    }
  }
  park_cars(plan, furniture, details);
  StreetNetwork network = city_network(plan);
  network.signals = furniture.signals();
  writer.set_scene_extras(fmt::format(R"({{"{}": {}}})", street_network_key, street_network_json(network)));
}

}  // namespace greatx::scene::generator
