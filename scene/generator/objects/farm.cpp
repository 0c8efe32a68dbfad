// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "scene/generator/objects/farm.h"

#include <algorithm>
#include <cmath>
#include <string>

#include "scene/generator/mesh/materials.h"

namespace greatx::scene::generator {

namespace {

struct House {
  double half_width, half_length, eaves, ridge;
  int wall, gable, roof;
};

/// Adds walls and gables under a roof that is a closed, overhanging slab of its own, 0.25 m thick. The slab
/// reaches 5 cm into the body, so that no two faces share a plane.
void add_house(MeshBuilder& mesh, const House& h) {
  const double w = snap(h.half_width), l = snap(h.half_length), bottom = -1.0;
  const double eaves = snap(h.eaves), ridge = snap(h.ridge);
  mesh.quad(h.wall, {w, -l, bottom}, {w, l, bottom}, {w, l, eaves}, {w, -l, eaves});
  mesh.quad(h.wall, {-w, l, bottom}, {-w, -l, bottom}, {-w, -l, eaves}, {-w, l, eaves});
  for (const double side : {-1.0, 1.0}) {
    const double y = side * l, x = side * w;
    const std::array<dvec3, 5> gable{dvec3(x, y, bottom), dvec3(-x, y, bottom), dvec3(-x, y, eaves),
                                     dvec3(0, y, ridge), dvec3(x, y, eaves)};
    mesh.polygon(h.gable, gable);
    mesh.quad(h.gable, {side * w, -side * l, eaves}, {side * w, side * l, eaves}, {0, side * l, ridge},
              {0, -side * l, ridge});
  }
  mesh.quad(h.gable, {-w, l, bottom}, {w, l, bottom}, {w, -l, bottom}, {-w, -l, bottom});

  const double overhang = 0.5, slope = (ridge - eaves) / w, out = w + overhang, thick = 0.25;
  const double low = snap(eaves - overhang * slope - 0.05), high = snap(ridge - 0.05);
  const std::vector<dvec2> chevron{{-out, low},        {0.0, high},         {out, low},
                                   {out, low + thick}, {0.0, high + thick}, {-out, low + thick}};
  mesh.prism_along_y(h.roof, chevron, -l - 0.4, l + 0.4);
}

}  // namespace

MeshBuilder make_farmhouse(double scale) {
  MeshBuilder mesh;
  const double w = 4.0 * scale, l = 8.0 * scale;
  add_house(mesh, {w, l, 3.0 + 3.0 * (scale > 0.6), 5.6 + 3.0 * (scale > 0.6), material("farm_plaster"),
                   material("blind_plaster"), material("farm_tiles")});
  const double top = 6.6 + 3.0 * (scale > 0.6);
  mesh.box(material("blind_brick"), {-0.4, 0.5 * l, 3.0}, {0.4, 0.5 * l + 0.7, top});
  mesh.box(material("door_boards"), {w - 0.05, -0.5, -0.3}, {w + 0.05, 0.5, 2.1});
  return mesh;
}

MeshBuilder make_barn(double scale, bool red) {
  MeshBuilder mesh;
  const double w = 5.5 * scale, l = 11.0 * scale, eaves = 4.4 * scale + 0.4;
  const int boards = material(red ? "barn_boards" : "barn_boards_brown");
  add_house(mesh,
            {w, l, eaves, eaves + 0.62 * w, boards, boards, material(red ? "roof_sheet" : "farm_tiles")});
  const double door = 0.4 * w;
  mesh.box(material("door_boards"), {-door, -l - 0.06, -0.3}, {door, -l + 0.05, 0.85 * eaves});
  return mesh;
}

MeshBuilder make_silo(double scale) {
  MeshBuilder mesh;
  const int sheet = material("roof_equipment");
  const double radius = 2.2 * scale, top = 9.0 * scale;
  const std::vector<dvec2> ring = regular_polygon(12, radius);
  for (size_t i = 0; i < ring.size(); ++i) {
    const dvec2 a = ring[i], b = ring[(i + 1) % ring.size()];
    mesh.quad(sheet, dvec3(a, -1.0), dvec3(b, -1.0), dvec3(b, top), dvec3(a, top));
    mesh.triangle(sheet, {dvec3(a, top), dvec3(b, top), dvec3(0, 0, top + 0.6 * radius)},
                  {dvec2(0.0, 1.0), dvec2(0.7, 1.0), dvec2(0.35, 0.0)});
  }
  mesh.flat_polygon(sheet, ring, -1.0, false);
  return mesh;
}

MeshBuilder make_pole() {
  MeshBuilder mesh;
  const int wood = material("wood_pole");
  mesh.prism(wood, wood, regular_polygon(6, 0.13), -0.6, 7.2);
  mesh.box(wood, {-0.05, -0.9, 6.6}, {0.05, 0.9, 6.74});
  const int glaze = material("insulator");
  for (const double y : {-pole_wire_y_m, pole_wire_y_m}) {
    mesh.prism(glaze, glaze, regular_polygon(6, 0.045, dvec2(0.0, y)), 6.72, 6.84);
    mesh.prism(glaze, glaze, regular_polygon(6, 0.03, dvec2(0.0, y)), 6.83, 6.9);
  }
  return mesh;
}

MeshBuilder make_bale() {
  MeshBuilder mesh;
  mesh.prism_along_y(material("straw"), regular_polygon(10, 0.65, dvec2(0.0, 0.62), 0.2), -0.6, 0.6);
  return mesh;
}

MeshBuilder make_trailer() {
  MeshBuilder mesh;
  const int boards = material("barn_boards_brown"), steel = material("painted_metal");
  mesh.box(steel, {-2.4, -0.5, 0.62}, {2.4, 0.5, 0.8});
  mesh.box(boards, {-2.5, -1.1, 0.78}, {2.5, 1.1, 0.92});
  for (const double y : {-1.08, 1.02}) mesh.box(boards, {-2.48, y, 0.9}, {2.48, y + 0.06, 1.5});
  for (const double x : {-2.46, 2.4}) mesh.box(boards, {x, -1.05, 0.91}, {x + 0.06, 1.05, 1.49});
  mesh.box(material("straw"), {-2.3, -0.98, 0.9}, {2.3, 0.98, 1.42});
  mesh.box(steel, {2.3, -0.06, 0.64}, {3.6, 0.06, 0.74});
  for (const double x : {-1.5, 1.5})
    for (const double y : {-1.0, 0.72})
      mesh.prism_along_y(material("tyre"), regular_polygon(8, 0.44, dvec2(x, 0.43), 0.4), y, y + 0.28);
  return mesh;
}

MeshBuilder make_rail_fence(double length_m) {
  MeshBuilder mesh;
  const int wood = material("wood_pole");
  const int posts = std::max(1, static_cast<int>(std::lround(length_m / 2.6)));
  for (int i = 0; i <= posts; ++i) {
    const double x = snap(length_m * i / posts);
    mesh.box(wood, {x - 0.06, -0.06, -0.5}, {x + 0.06, 0.06, 1.2});
  }
  for (const double z : {0.5, 0.98}) mesh.box(wood, {-0.08, 0.04, z}, {length_m + 0.08, 0.09, z + 0.12});
  return mesh;
}

}  // namespace greatx::scene::generator
