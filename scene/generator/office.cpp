// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "scene/generator/office.h"

#include <array>
#include <cmath>

#include <fmt/format.h>

#include "core/random.h"
#include "core/units.h"
#include "scene/generator/mesh/materials.h"
#include "scene/generator/mesh/mesh_builder.h"

namespace greatx::scene::generator {

namespace {

constexpr double ceiling_m = 3.2, lamp_drop_m = 0.06;  // the lights hang free of the ceiling
constexpr std::array<double, 4> lamp_x{-4.5, -1.5, 1.5, 4.5};
constexpr std::array<double, 2> lamp_y{-2.0, 2.0};

/// A flat light with a diffuser: its intensity falls with the angle as that of a plane that shines evenly, to
/// KHR_lights_punctual's accuracy.
LightSpec panel_light() {
  LightSpec light{
      .color = lamp_color_4000k, .intensity_cd = 1.0, .range_m = 0.0, .inner_cone = 0.2, .outer_cone = 1.55};
  light.intensity_cd = std::round(room_lamp_lm / light.flux_lm());
  return light;
}

MeshBuilder make_table() {
  MeshBuilder mesh;
  const int wood = material("bench_wood"), metal = material("painted_metal");
  mesh.box(wood, {-0.8, -0.4, 0.71}, {0.8, 0.4, 0.74});
  for (const double x : {-0.74, 0.70})
    for (const double y : {-0.34, 0.30}) mesh.box(metal, {x, y, 0.0}, {x + 0.04, y + 0.04, 0.72});
  return mesh;
}

MeshBuilder make_chair() {
  MeshBuilder mesh;
  const int seat = material("bumper"), metal = material("galvanised_metal");
  mesh.box(seat, {-0.22, -0.22, 0.43}, {0.22, 0.22, 0.47});
  mesh.box(seat, {-0.22, 0.19, 0.6}, {0.22, 0.22, 0.92});
  for (const double x : {-0.2, 0.17})
    for (const double y : {-0.2, 0.185})
      mesh.box(metal, {x, y, 0.0}, {x + 0.03, y + 0.03, y > 0 ? 0.9 : 0.44});
  return mesh;
}

MeshBuilder make_screen() {
  MeshBuilder mesh;
  const int black = material("signal_housing");
  mesh.box(black, {-0.27, -0.015, 0.86}, {0.27, 0.015, 1.18});
  mesh.box(black, {-0.02, 0.0, 0.73}, {0.02, 0.03, 0.9});
  mesh.box(black, {-0.12, -0.08, 0.735}, {0.12, 0.08, 0.75});
  return mesh;
}

/// A shelf of 1.8 m along x whose back is at y = 0, with books of a few widths and heights.
MeshBuilder make_shelf(uint64_t seed) {
  MeshBuilder mesh;
  const int wood = material("bench_wood");
  for (const double x : {-0.9, 0.87}) mesh.box(wood, {x, -0.32, 0.0}, {x + 0.03, -0.02, 2.0});
  RandomStream random(seed, 1, 0);
  static constexpr std::array<const char*, 5> covers{"car_paint_red", "car_paint_blue", "car_paint_sand",
                                                     "car_paint_green", "car_paint_grey"};
  for (int level = 0; level < 5; ++level) {
    const double z = 0.08 + 0.45 * level;
    mesh.box(wood, {-0.88, -0.31, z}, {0.88, -0.03, z + 0.03});
    for (double x = -0.82; level < 4 && x < 0.72;) {
      const double width = snap(random.uniform(0.05, 0.18)), height = snap(random.uniform(0.2, 0.32));
      if (random.uniform() < 0.8)
        mesh.box(material(covers[random.below(covers.size())]), {x, -0.28, z + 0.031},
                 {x + width, -0.08, z + 0.031 + height});
      x += width + 0.012;
    }
  }
  return mesh;
}

}  // namespace

void add_room_lights(SceneWriter& writer) {
  const int light = writer.add_light(panel_light());
  for (size_t i = 0; i < lamp_x.size(); ++i)
    for (size_t k = 0; k < lamp_y.size(); ++k)
      writer.add_node({.name = fmt::format("ceiling_light_{}{}", i, k),
                       .position = {lamp_x[i], lamp_y[k], ceiling_m - lamp_drop_m - 0.04},
                       .light = light,
                       .shine = {0.0, 0.0, -1.0}});
}

void add_furniture(SceneWriter& writer) {
  MeshBuilder panel;
  panel.box(material("panel_glass"), {-0.3, -0.3, -0.03}, {0.3, 0.3, 0.0});
  const int panel_mesh = writer.add_mesh("panel", panel);
  for (size_t i = 0; i < lamp_x.size(); ++i)
    for (size_t k = 0; k < lamp_y.size(); ++k)
      writer.add_node({.name = fmt::format("panel_{}{}", i, k),
                       .mesh = panel_mesh,
                       .position = {lamp_x[i], lamp_y[k], ceiling_m - lamp_drop_m},
                       .semantic_class = SemanticClass::furniture});
  const int table = writer.add_mesh("table", make_table()), chair = writer.add_mesh("chair", make_chair()),
            screen = writer.add_mesh("screen", make_screen());
  const auto put = [&](const std::string& name, int mesh, const dvec3& at, double yaw) {
    writer.add_node(
        {.name = name, .mesh = mesh, .position = at, .yaw = yaw, .semantic_class = SemanticClass::furniture});
  };
  for (int i = 0; i < 6; ++i) {
    const double x = -2.6 + 2.6 * (i / 2), y = i % 2 == 0 ? -1.2 : 1.2, yaw = i % 2 == 0 ? 0.0 : pi;
    const double side = i % 2 == 0 ? 1.0 : -1.0;
    put(fmt::format("table_{}", i), table, {x, y, 0.0}, yaw);
    put(fmt::format("chair_{}", i), chair, {x + 0.15, y + side * 0.62, 0.0}, yaw + (i % 3 - 1) * 0.35);
    put(fmt::format("screen_{}", i), screen, {x, y - side * 0.12, 0.005}, yaw);
  }
  for (int i = 0; i < 2; ++i)
    put(fmt::format("shelf_{}", i), writer.add_mesh(fmt::format("shelf_{}", i), make_shelf(3 + uint64_t(i))),
        {-3.4 + 2.2 * i, 3.99, 0.0}, 0.0);
  MeshBuilder wall;
  wall.box(material("door_boards"), {-5.99, -3.1, 0.005}, {-5.94, -2.15, 2.1});
  wall.box(material("road_marking"), {-5.99, -1.2, 0.95}, {-5.96, 1.6, 2.25});
  writer.add_node({.name = "door_and_board",
                   .mesh = writer.add_mesh("door_and_board", wall),
                   .semantic_class = SemanticClass::furniture});
}

}  // namespace greatx::scene::generator
