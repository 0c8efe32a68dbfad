// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include <array>
#include <cmath>
#include <functional>
#include <map>
#include <string>

#include <fmt/format.h>

#include "core/units.h"
#include "scene/generator/city_buildings.h"
#include "scene/generator/city_ground.h"
#include "scene/generator/kinds.h"
#include "scene/generator/materials.h"
#include "scene/generator/objects.h"

namespace greatx::scene::generator {

namespace {

/// Meshes that many nodes share, and running numbers for the nodes' names.
class CityFurniture {
 public:
  explicit CityFurniture(GlbWriter& writer) : writer_(writer) {
    light_ = writer.add_point_light("lamp_light", vec3(1.0f, 0.86f, 0.66f), 900.0, 40.0);
  }

  void tree(const dvec2& where, double z, RandomStream& random) {
    const int shape = static_cast<int>(random.below(4));
    const int mesh = shared(fmt::format("tree_shape_{}", shape), [&] { return make_tree(shape); });
    const double scale = random.uniform(0.85, 1.3), yaw = random.uniform(0.0, 2.0 * pi);
    writer_.add_node({.name = fmt::format("tree_{:03}", tree_count_++),
                      .mesh = mesh,
                      .position = dvec3(where, z),
                      .yaw = yaw,
                      .scale = scale,
                      .semantic_class = SemanticClass::vegetation});
  }
  void lamp(const dvec2& where, double z, double yaw) {
    const std::string name = fmt::format("lamp_{:03}", lamp_count_++);
    const int node = writer_.add_node({.name = name,
                                       .mesh = shared("street_lamp", make_lamp),
                                       .position = dvec3(where, z),
                                       .yaw = yaw,
                                       .semantic_class = SemanticClass::street_lamp});
    writer_.add_node(
        {.name = name + "_light", .position = lamp_light_position, .parent = node, .light = light_});
  }
  void car(const dvec2& where, double yaw, RandomStream& random) {
    static constexpr std::array<const char*, 6> paints{"white", "silver", "red", "blue", "black", "silver"};
    const size_t pick = random.below(7);
    const std::string variant = pick < 6 ? "hatchback" : "van";
    const std::string paint = pick < 6 ? paints[pick] : "white";
    const int mesh = shared(fmt::format("parked_{}_{}", variant, paint),
                            [&] { return make_car(variant, "car_paint_" + paint, false); });
    writer_.add_node({.name = fmt::format("car_{:03}", car_count_++),
                      .mesh = mesh,
                      .position = dvec3(where, 0.0),
                      .yaw = yaw,
                      .semantic_class = SemanticClass::vehicle});
  }
  void bench(const dvec2& where, double z, double yaw) {
    writer_.add_node({.name = fmt::format("bench_{:03}", bench_count_++),
                      .mesh = shared("bench", make_bench),
                      .position = dvec3(where, z),
                      .yaw = yaw,
                      .semantic_class = SemanticClass::furniture});
  }

 private:
  int shared(const std::string& name, const std::function<MeshBuilder()>& make) {
    const auto found = meshes_.find(name);
    if (found != meshes_.end()) return found->second;
    return meshes_[name] = writer_.add_mesh(name, make());
  }

  GlbWriter& writer_;
  std::map<std::string, int> meshes_;
  int light_ = 0;
  int tree_count_ = 0, lamp_count_ = 0, car_count_ = 0, bench_count_ = 0;
};

double heading(const dvec2& direction) { return std::atan2(direction.y, direction.x); }

/// Lamps along the south and west edges of a block (so that each street has one row), trees along avenues.
void furnish_pavement(const Block& block, CityFurniture& furniture, RandomStream& random) {
  for (int edge = 0; edge < 4; ++edge) {
    if (!block.street[static_cast<size_t>(edge)]) continue;
    const dvec2 a = block.edge_start(edge), b = block.edge_end(edge);
    const double length = glm::length(b - a);
    const dvec2 along = (b - a) / length, inwards(-along.y, along.x);
    const bool avenue = block.pavement_m[static_cast<size_t>(edge)] >= 4.0;
    const bool lamps = edge == 0 || edge == 3;
    const int slots = std::max(2, static_cast<int>(length / (avenue ? 12.0 : 16.0)));
    for (int i = 0; i < slots; ++i) {
      const dvec2 spot = a + along * (length * (i + 0.5) / slots) + inwards * 0.7;
      if (lamps && i % 3 == 1)
        furniture.lamp(spot, pavement_height_m, heading(-inwards));
      else if (avenue && i % 3 != 1)
        furniture.tree(spot + inwards * 0.5, pavement_height_m, random);
    }
  }
}

void park_cars(const CityPlan& plan, CityFurniture& furniture, RandomStream& random) {
  for (const Street& street : plan.streets) {
    if (street.avenue) continue;
    const double length = glm::length(street.right[1] - street.right[0]);
    const dvec2 along = (street.right[1] - street.right[0]) / length, left(-along.y, along.x);
    const int slots = static_cast<int>((length - 16.0) / 6.2);
    for (int i = 0; i < slots; ++i) {
      if (random.uniform() > 0.13) continue;
      const dvec2 spot = street.right[0] + along * (9.0 + 6.2 * i + random.uniform(-0.3, 0.3)) + left * 1.25;
      furniture.car(spot, heading(along), random);
    }
  }
}

/// Lawn with paths, trees and benches around a small plaza with a fountain.
void add_park(GlbWriter& writer, const Block& block, CityFurniture& furniture, RandomStream& random) {
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

  for (int i = 0; i < 5; ++i)
    for (int j = 0; j < 5; ++j) {
      if (i == 2 || j == 2) continue;
      const double u = 0.1 + 0.2 * i + random.uniform(-0.045, 0.045);
      const double v = 0.1 + 0.2 * j + random.uniform(-0.045, 0.045);
      furniture.tree(at(u, v), z, random);
    }
  for (int i = 0; i < 4; ++i) {
    const double angle = pi / 4 + pi / 2 * i;
    const dvec2 out(std::cos(angle), std::sin(angle));
    furniture.bench(center + 6.6 * out, z + 0.06, angle - pi / 2);
  }
}

}  // namespace

void write_city(GlbWriter& writer, double size_m, uint64_t seed) {
  const CityPlan plan = plan_city(size_m, seed);
  const auto add = [&](const std::string& name, const MeshBuilder& mesh, SemanticClass semantic_class) {
    writer.add_node({.name = name, .mesh = writer.add_mesh(name, mesh), .semantic_class = semantic_class});
  };
  MeshBuilder base, road, markings;
  add_streets(plan, seed, road, markings);
  add_base(plan, base);
  add("road", road, SemanticClass::road);
  add("lane_markings", markings, SemanticClass::lane_marking);
  add("ground_base", base, SemanticClass::ground);

  CityFurniture furniture(writer);
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
    furnish_pavement(block, furniture, details);
    if (park) {
      add_park(writer, block, furniture, details);
      continue;
    }
    for (const Building& b : make_buildings(plan, block, random)) {
      const std::string name = fmt::format("building_{:03}", building++);
      writer.add_node({.name = name,
                       .mesh = writer.add_mesh(name, b.mesh),
                       .position = b.position,
                       .semantic_class = SemanticClass::building});
    }
  }
  park_cars(plan, furniture, details);
}

}  // namespace greatx::scene::generator
