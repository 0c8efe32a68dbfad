// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "scene/generator/objects/street_pieces.h"

#include <cmath>

#include "core/units.h"
#include "scene/generator/mesh/materials.h"
#include "scene/generator/objects/trees.h"
#include "scene/generator/paint/texture_painter.h"

namespace greatx::scene::generator {

namespace {

/// Adds an upright closed box whose front (+x or +y) and back show a part of a picture from top left (u0, v0)
/// to bottom right (u1, v1). Its narrow sides show the picture's corner.
struct Panel {
  dvec3 low, high;
  dvec2 front0{0.0}, front1{1.0}, back0{0.0}, back1{1.0};
};
void add_panel_facing_x(MeshBuilder& mesh, int material, const Panel& p) {
  const dvec3 a = p.low, b = p.high;
  const auto side = [&](const std::array<dvec3, 4>& corners, const dvec2& u0, const dvec2& u1) {
    mesh.quad(material, corners, {dvec2(u0.x, u1.y), u1, dvec2(u1.x, u0.y), u0});
  };
  side({dvec3(b.x, a.y, a.z), dvec3(b.x, b.y, a.z), dvec3(b.x, b.y, b.z), dvec3(b.x, a.y, b.z)}, p.front0,
       p.front1);
  side({dvec3(a.x, b.y, a.z), dvec3(a.x, a.y, a.z), dvec3(a.x, a.y, b.z), dvec3(a.x, b.y, b.z)}, p.back0,
       p.back1);
  const dvec2 edge = p.back0;
  side({dvec3(a.x, a.y, a.z), dvec3(b.x, a.y, a.z), dvec3(b.x, a.y, b.z), dvec3(a.x, a.y, b.z)}, edge, edge);
  side({dvec3(b.x, b.y, a.z), dvec3(a.x, b.y, a.z), dvec3(a.x, b.y, b.z), dvec3(b.x, b.y, b.z)}, edge, edge);
  side({dvec3(a.x, a.y, b.z), dvec3(b.x, a.y, b.z), dvec3(b.x, b.y, b.z), dvec3(a.x, b.y, b.z)}, edge, edge);
  side({dvec3(a.x, b.y, a.z), dvec3(b.x, b.y, a.z), dvec3(b.x, a.y, a.z), dvec3(a.x, a.y, a.z)}, edge, edge);
}

/// Adds a bush: a closed body of leaves with sprays, `radius` wide and `high` from z.
void add_bush(MeshBuilder& mesh, const dvec2& at, double z, double radius, double high, uint32_t seed) {
  LeafBody body;
  for (const auto& [level, wide] : {std::pair{0.25, 0.9}, std::pair{0.75, 0.75}}) {
    std::vector<dvec3> ring;
    for (const dvec2& p : regular_polygon(5, radius * wide, at, 0.3 + static_cast<double>(seed % 7)))
      ring.push_back(snap(dvec3(p, z + level * high)));
    body.rings.push_back(std::move(ring));
  }
  body.bottom = snap(dvec3(at, z));
  body.top = snap(dvec3(at, z + high));
  add_leaf_body(mesh, material("hedge"), body);
  add_sprays(mesh, material("sprays_hedge"), body, {1, 1.5 * radius, 0.3}, seed);
}

void add_chair(MeshBuilder& mesh, const dvec2& at, double facing) {
  MeshBuilder chair;
  const int seat = material("chair"), metal = material("painted_metal");
  const std::vector<dvec2> profile{{-0.24, 0.44}, {0.21, 0.44}, {0.21, 0.48},
                                   {-0.2, 0.48},  {-0.2, 0.86}, {-0.24, 0.86}};
  chair.prism_along_y(seat, profile, -0.21, 0.21);
  chair.box(metal, {-0.17, -0.17, -0.02}, {0.17, 0.17, 0.42});
  mesh.append(chair, dvec3(at, 0.0), facing);
}

}  // namespace

MeshBuilder make_bollard() {
  MeshBuilder mesh;
  mesh.box(material("painted_metal"), {-0.06, -0.06, -0.05}, {0.06, 0.06, 0.95});
  return mesh;
}

MeshBuilder make_bicycle_rack(uint32_t draw) {
  MeshBuilder mesh;
  const int steel = material("galvanised_metal");
  for (int i = 0; i < 3; ++i) {
    const double x = 0.9 * (i - 1);
    for (const double y : {-0.36, 0.32}) mesh.box(steel, {x, y, -0.05}, {x + 0.04, y + 0.04, 0.78});
    mesh.box(steel, {x + 0.004, -0.356, 0.76}, {x + 0.036, 0.356, 0.8});
    const uint32_t kind = hash(i, 1, draw) % 3;
    if (kind == 2) continue;
    // The sheet leans on its hoop.
    MeshBuilder bicycle;
    const double v = 0.5 * kind;
    add_panel_facing_x(
        bicycle, material("bicycle"),
        {{-0.012, -0.88, 0.01}, {0.012, 0.88, 1.07}, {0.0, v}, {1.0, v + 0.5}, {1.0, v}, {0.0, v + 0.5}});
    bicycle.box(material("bumper"), {-0.25, 0.42, 1.0}, {0.25, 0.46, 1.04});
    mesh.append(bicycle, {x + 0.1, 0.05 * (i - 1), 0.0});
  }
  return mesh;
}

MeshBuilder make_post_box() {
  MeshBuilder mesh;
  const int yellow = material("post_yellow"), dark = material("signal_housing");
  mesh.box(dark, {-0.16, -0.16, -0.05}, {0.16, 0.16, 0.62});
  mesh.box(yellow, {-0.24, -0.28, 0.6}, {0.24, 0.28, 1.22});
  mesh.box(dark, {0.2, -0.18, 1.05}, {0.25, 0.18, 1.09});
  return mesh;
}

MeshBuilder make_hydrant() {
  MeshBuilder mesh;
  const int red = material("hydrant_red");
  mesh.prism(red, red, regular_polygon(5, 0.11), -0.05, 0.72);
  mesh.box(red, {-0.06, -0.19, 0.42}, {0.06, 0.19, 0.54});
  return mesh;
}

MeshBuilder make_planter(uint32_t draw) {
  MeshBuilder mesh;
  const int concrete = material("concrete");
  mesh.box(concrete, {-0.8, -0.3, -0.05}, {0.8, 0.3, 0.5});
  add_bush(mesh, {draw % 2 == 0 ? -0.2 : 0.25, 0.0}, 0.45, 0.32, 0.75, draw + 1);
  return mesh;
}

MeshBuilder make_advertising_column() {
  MeshBuilder mesh;
  const int green = material("column_green"), bills = material("column_bills");
  const std::vector<dvec2> ring = regular_polygon(10, 0.58);
  mesh.prism(green, green, regular_polygon(10, 0.64), -0.05, 0.42);
  for (size_t i = 0; i < ring.size(); ++i) {
    const dvec2 a = ring[i], b = ring[(i + 1) % ring.size()];
    const double u0 = static_cast<double>(i) / 10.0, u1 = u0 + 0.1;
    mesh.quad(bills, {dvec3(a, 0.4), dvec3(b, 0.4), dvec3(b, 2.9), dvec3(a, 2.9)},
              {dvec2(u0, 1.0), dvec2(u1, 1.0), dvec2(u1, 0.0), dvec2(u0, 0.0)});
  }
  mesh.flat_polygon(green, ring, 0.4, false);
  mesh.flat_polygon(green, ring, 2.9, true);
  mesh.prism(green, green, regular_polygon(10, 0.72), 2.86, 3.06);
  mesh.prism(green, green, regular_polygon(6, 0.4), 3.04, 3.4);
  return mesh;
}

MeshBuilder make_cabinet() {
  MeshBuilder mesh;
  const int grey = material("cabinet_grey");
  mesh.box(grey, {-0.6, -0.2, -0.05}, {0.6, 0.2, 1.25});
  mesh.box(grey, {-0.63, -0.23, 1.23}, {0.63, 0.24, 1.29});
  return mesh;
}

MeshBuilder make_cafe() {
  MeshBuilder mesh;
  const int top = material("chair"), metal = material("painted_metal");
  for (const double x : {-1.15, 1.15}) {
    mesh.box(top, {x - 0.34, -0.34, 0.7}, {x + 0.34, 0.34, 0.74});
    mesh.box(metal, {x - 0.04, -0.04, -0.02}, {x + 0.04, 0.04, 0.72});
    add_chair(mesh, {x - 0.72, 0.05}, 0.0);
    add_chair(mesh, {x + 0.7, -0.04}, pi);
  }
  return mesh;
}

MeshBuilder make_tree_grate() {
  MeshBuilder mesh;
  const int iron = material("tree_grate");
  const dvec2 low(-0.75, -0.75), high(0.75, 0.75);
  mesh.box(iron, dvec3(low, -0.06), dvec3(high, 0.012));
  return mesh;
}

MeshBuilder make_traffic_sign(SignKind kind) {
  MeshBuilder mesh;
  const int number = static_cast<int>(kind);
  const dvec2 at(0.25 * (number % 4), 0.25 * (number / 4)),
      grey(0.25 * (number % 4), 0.5 + 0.25 * (number / 4));
  mesh.box(material("galvanised_metal"), {-0.03, -0.03, -0.1}, {0.03, 0.03, 3.0});
  add_panel_facing_x(mesh, material("traffic_signs"),
                     {{0.031, -0.31, 2.3}, {0.051, 0.31, 2.92}, at, at + 0.25, grey, grey + 0.25});
  return mesh;
}

MeshBuilder make_stop_pole() {
  MeshBuilder mesh;
  mesh.box(material("galvanised_metal"), {-0.03, -0.03, -0.1}, {0.03, 0.03, 2.95});
  mesh.box(material("post_yellow"), {-0.02, -0.36, 2.4}, {0.02, 0.36, 2.9});
  mesh.box(material("number_plate"), {0.025, -0.2, 1.25}, {0.055, 0.2, 1.9});
  return mesh;
}

MeshBuilder make_site_fence() {
  MeshBuilder mesh;
  const int steel = material("scaffold_tube"), concrete = material("concrete");
  add_panel_facing_x(
      mesh, material("mesh_fence"),
      {{-0.012, -1.7, 0.16}, {0.012, 1.7, 2.0}, {0.0, 0.0}, {12.0, 6.0}, {0.0, 0.0}, {12.0, 6.0}});
  for (const double y : {-1.72, 1.68}) {
    mesh.box(steel, {-0.02, y, 0.05}, {0.02, y + 0.04, 2.04});
    mesh.box(concrete, {-0.36, y - 0.1, -0.01}, {0.36, y + 0.14, 0.14});
  }
  mesh.box(steel, {-0.015, -1.71, 1.98}, {0.015, 1.71, 2.02});
  MeshBuilder turned;
  turned.append(mesh, dvec3(0.0), 0.5 * pi);
  return turned;
}

}  // namespace greatx::scene::generator
