// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "scene/generator/objects/objects.h"

#include <array>
#include <cmath>

#include "core/units.h"
#include "scene/generator/mesh/materials.h"

namespace greatx::scene::generator {

MeshBuilder make_bench() {
  MeshBuilder mesh;
  const int wood = material("bench_wood"), metal = material("painted_metal");
  mesh.box(wood, {-0.9, -0.22, 0.42}, {0.9, 0.22, 0.47});
  mesh.box(wood, {-0.9, 0.18, 0.55}, {0.9, 0.215, 0.95});
  for (const double x : {-0.75, 0.69}) mesh.box(metal, {x, -0.18, -0.05}, {x + 0.06, 0.23, 0.9});
  return mesh;
}

MeshBuilder make_mast() {
  MeshBuilder mesh;
  const int steel = material("galvanised_metal"), dark = material("painted_metal");
  // foundation and cabinet
  mesh.prism(material("concrete"), material("concrete"), regular_polygon(8, 1.5, dvec2(0.0), pi / 8), -0.5,
             0.25);
  mesh.box(material("radome"), {1.7, -0.6, -0.1}, {2.4, 0.6, 1.7});
  // three sections of pole, each narrower than the one below, with flanges between them
  const std::array<double, 4> levels{0.1, 8.5, 16.5, 24.2};
  for (size_t i = 0; i < 3; ++i) {
    const double radius = 0.42 - 0.09 * static_cast<double>(i);
    mesh.prism(steel, steel, regular_polygon(10, radius), levels[i] - (i == 0 ? 0.0 : 0.05), levels[i + 1]);
    mesh.prism(steel, steel, regular_polygon(10, radius + 0.1, dvec2(0.0), 0.2),
               levels[i] + (i == 0 ? 0.1 : -0.08), levels[i] + (i == 0 ? 0.22 : 0.08));
  }
  // ladder: two rails and rungs, on the side of the cabinet
  for (const double y : {-0.22, 0.18}) mesh.box(dark, {0.5, y, 0.3}, {0.54, y + 0.04, 23.9});
  for (int rung = 0; rung < 24; ++rung) {
    const double z = 0.8 + 0.95 * rung;
    mesh.box(dark, {0.505, -0.2, z}, {0.535, 0.2, z + 0.03});
  }
  // three panel antennas on brackets, 120 degrees apart, with a remote radio unit behind each
  for (int sector = 0; sector < 3; ++sector) {
    MeshBuilder arm;
    arm.box(material("radome"), {0.95, -0.2, 21.2}, {1.12, 0.2, 23.4});
    for (const double z : {21.6, 22.9}) arm.box(dark, {0.1, -0.05, z}, {0.98, 0.05, z + 0.1});
    arm.box(steel, {0.84, -0.035, 20.9}, {0.91, 0.035, 23.7});
    arm.box(material("uav_shell"), {0.5, -0.17, 21.9}, {0.78, 0.17, 22.5});
    mesh.append(arm, dvec3(0.0), pi / 3 + 2.0 * pi * sector / 3);
  }
  // top platform and its low rail
  mesh.prism(steel, steel, regular_polygon(8, 0.95, dvec2(0.0), pi / 8), 24.1, 24.18);
  const std::vector<dvec2> posts = regular_polygon(8, 0.86, dvec2(0.0), pi / 8);
  for (const dvec2& p : posts) mesh.box(dark, dvec3(p - 0.02, 24.12), dvec3(p + 0.02, 24.5));
  mesh.box(material("aviation_light"), {-0.08, -0.08, 24.19}, {0.08, 0.08, 24.35});
  return mesh;
}

}  // namespace greatx::scene::generator
