// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Writes two plain scenes for radio: a street between two rows of houses, and a closed room.
#include "scene/generator/canyon.h"

#include <array>
#include <vector>

#include <fmt/format.h>

#include "core/random.h"
#include "core/units.h"
#include "scene/generator/mesh/materials.h"
#include "scene/generator/mesh/mesh_builder.h"
#include "scene/generator/office.h"

namespace greatx::scene::generator {

namespace {

constexpr double carriageway = 5.0;  // half width
constexpr double frontage = 9.0;     // distance of the fronts of the houses from the middle of the street
constexpr double yard = 27.0;        // distance of the edge of the scene from the middle of the street
constexpr double pavement_z = 0.15;
constexpr double foundation = -0.45;  // below the pavement, so that no face ends in its plane

/// One side of the cross-section (x, z) of the street. The section runs clockwise as seen from -y.
struct Section {
  dvec2 from, to;
  const char* material;
  size_t node;  ///< 0 road, 1 and 2 pavements, 3 the rest
};

std::vector<Section> street_section() {
  const double z = pavement_z;
  return {{{-carriageway, 0}, {carriageway, 0}, "asphalt", 0},
          {{-frontage, z}, {-carriageway, z}, "pavement", 1},
          {{-carriageway, z}, {-carriageway, 0}, "kerb", 1},
          {{carriageway, 0}, {carriageway, z}, "kerb", 2},
          {{carriageway, z}, {frontage, z}, "pavement", 2},
          {{frontage, z}, {yard, z}, "asphalt_lot", 3},
          {{yard, z}, {yard, -1}, "subsoil", 3},
          {{yard, -1}, {-yard, -1}, "subsoil", 3},
          {{-yard, -1}, {-yard, z}, "subsoil", 3},
          {{-yard, z}, {-frontage, z}, "asphalt_lot", 3}};
}

void add_ground(SceneWriter& writer, double half_length) {
  std::array<MeshBuilder, 4> meshes;
  for (const Section& s : street_section())
    meshes[s.node].quad(material(s.material), {s.from.x, -half_length, s.from.y},
                        {s.to.x, -half_length, s.to.y}, {s.to.x, half_length, s.to.y},
                        {s.from.x, half_length, s.from.y});
  // The ends have every corner of the section, so that the ground stays closed.
  const double z = pavement_z;
  std::vector<dvec3> end;
  for (const dvec2& p : std::vector<dvec2>{{-yard, -1},
                                           {-yard, z},
                                           {-frontage, z},
                                           {-carriageway, z},
                                           {-carriageway, 0},
                                           {carriageway, 0},
                                           {carriageway, z},
                                           {frontage, z},
                                           {yard, z},
                                           {yard, -1}})
    end.emplace_back(p.x, half_length, p.y);
  meshes[3].polygon(material("subsoil"), end);
  std::vector<dvec3> other(end.rbegin(), end.rend());
  for (dvec3& p : other) p.y = -half_length;
  meshes[3].polygon(material("subsoil"), other);

  const std::array<const char*, 4> names{"road", "pavement_000", "pavement_001", "ground_base"};
  const std::array<SemanticClass, 4> classes{SemanticClass::road, SemanticClass::pavement,
                                             SemanticClass::pavement, SemanticClass::ground};
  for (size_t i = 0; i < meshes.size(); ++i)
    writer.add_node(
        {.name = names[i], .mesh = writer.add_mesh(names[i], meshes[i]), .semantic_class = classes[i]});
}

/// Makes a house about the middle of its front, which faces +x. Bay windows stand out of the front.
MeshBuilder make_house(double width, double depth, int floors, RandomStream& random) {
  static constexpr std::array<const char*, 6> facades{"facade_brick_red",     "facade_plaster_cream",
                                                      "facade_concrete_grey", "facade_plaster_white",
                                                      "facade_brick_yellow",  "facade_glass_blue"};
  const int facade = material(facades[random.below(facades.size())]);
  const int stone = material("concrete"), roof = material("roof_gravel");
  const double half = 0.5 * width, top = 3.2 * floors;
  RingSolid solid;
  solid.footprint = {{-depth, -half}, {0, -half}, {0, half}, {-depth, half}};
  solid.bottom = stone;
  solid.rings = {{0.0, foundation, facade, true, 0.0},
                 {0.0, top + 0.8, stone},
                 {0.35, top + 0.8, stone},
                 {0.35, top, roof}};
  MeshBuilder mesh;
  add_ring_solid(mesh, solid);
  const uint32_t bays = random.below(3);
  for (uint32_t i = 0; i < bays; ++i) {
    const double y = snap((i + 0.5) / bays * width - half), out = snap(random.uniform(0.5, 0.9));
    mesh.box(material("facade_metal_silver"), {-0.2, y - 1.3, 3.5}, {out, y + 1.3, top - 0.5});
  }
  return mesh;
}

}  // namespace

void write_canyon(SceneWriter& writer, double size_m, uint64_t seed) {
  const double half_length = snap(0.5 * size_m);
  add_ground(writer, half_length);
  RandomStream random(seed, 5);
  int number = 0;
  for (const double side : {-1.0, 1.0}) {
    double y = -half_length + 1.0;
    for (;;) {
      const double width = snap(random.uniform(13.0, 25.0)), depth = snap(random.uniform(10.0, 14.0));
      const double back = random.uniform() < 0.5 ? 0.0 : snap(random.uniform(0.2, 1.5));
      const int floors = 3 + static_cast<int>(random.below(6));
      if (y + width > half_length - 1.0) break;
      const std::string name = fmt::format("building_{:03}", number++);
      writer.add_node({.name = name,
                       .mesh = writer.add_mesh(name, make_house(width, depth, floors, random)),
                       .position = {side * (frontage + back), snap(y + 0.5 * width), pavement_z},
                       .yaw = side < 0.0 ? 0.0 : pi,
                       .semantic_class = SemanticClass::building});
      y += width + snap(random.uniform(1.5, 6.0));  // an alley, since houses do not share a wall
    }
  }
}

void write_room(SceneWriter& writer) {
  MeshBuilder mesh;
  const double x = 6.0, y = 4.0, z = 3.2;
  const int wall = material("blind_plaster"), glass = material("shopfront"), stone = material("concrete");
  mesh.quad(wall, {-x, -y, 0}, {-x, y, 0}, {-x, y, z}, {-x, -y, z});  // each wall faces inwards
  mesh.quad(glass, {x, -y, 0}, {x, -y, z}, {x, y, z}, {x, y, 0});
  mesh.quad(wall, {-x, -y, 0}, {-x, -y, z}, {x, -y, z}, {x, -y, 0});
  mesh.quad(wall, {-x, y, 0}, {x, y, 0}, {x, y, z}, {-x, y, z});
  mesh.quad(stone, {-x, -y, 0}, {x, -y, 0}, {x, y, 0}, {-x, y, 0});
  mesh.quad(stone, {-x, -y, z}, {-x, y, z}, {x, y, z}, {x, -y, z});
  add_room_lights(writer);
  writer.add_node(
      {.name = "room", .mesh = writer.add_mesh("room", mesh), .semantic_class = SemanticClass::building});
}

}  // namespace greatx::scene::generator
