// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "scene/generator/objects/street_furniture.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "core/units.h"
#include "scene/generator/mesh/materials.h"

namespace greatx::scene::generator {

namespace {

/// Makes a spot light with this luminous flux (LightSpec::flux_lm). It has full intensity up to the angle
/// `inner` and none beyond `outer`, both in degrees from straight down.
LightSpec downlight(const vec3& color, double flux_lm, double inner, double outer, double range_m) {
  LightSpec light{.color = color,
                  .intensity_cd = 1.0,
                  .range_m = range_m,
                  .inner_cone = inner * pi / 180.0,
                  .outer_cone = outer * pi / 180.0};
  light.intensity_cd = std::round(flux_lm / light.flux_lm());
  return light;
}

/// Makes pole, arm and head. The glass is the underside of the head.
MeshBuilder arm_lamp(double height, double reach, const char* glass) {
  MeshBuilder mesh;
  const int metal = material("painted_metal");
  const double head = reach + 0.6;
  mesh.box(metal, {-0.07, -0.07, -0.1}, {0.07, 0.07, height + 0.17});
  mesh.box(metal, {0.02, -0.1, height + 0.05}, {head + 0.05, 0.1, height + 0.16});
  mesh.box(material(glass), {reach, -0.15, height}, {head, 0.15, height + 0.08});
  return mesh;
}

/// Adds a closed prism between x0 and x1 over a profile in the y-z plane that is counter-clockwise as seen
/// from +x.
void add_prism_along_x(MeshBuilder& mesh, int material, const std::vector<dvec2>& profile, double x0,
                       double x1) {
  std::vector<dvec3> front, back;
  for (const dvec2& p : profile) {
    front.push_back(snap(dvec3(x1, p)));
    back.push_back(snap(dvec3(x0, p)));
  }
  for (size_t i = 0; i < profile.size(); ++i) {
    const size_t j = (i + 1) % profile.size();
    mesh.quad(material, back[i], back[j], front[j], front[i]);
  }
  mesh.polygon(material, front);
  std::ranges::reverse(back);
  mesh.polygon(material, back);
}

/// Adds a round lens of 200 mm before the front of a housing at x, and the hood above it.
void add_lens(MeshBuilder& mesh, const char* lens, double x, double z) {
  constexpr double radius = 0.1, proud = 0.004;
  std::vector<dvec3> corners;
  for (const dvec2& p : regular_polygon(12, radius, dvec2(0.0, z), pi / 12.0))
    corners.push_back(snap(dvec3(x + proud, p)));
  mesh.polygon(material(lens), corners);
  // Drivers look from below, and see the lens beneath a roof.
  const double inner = radius + 0.01, outer = radius + 0.03, eaves = z + 0.03;
  add_prism_along_x(
      mesh, material("signal_housing"),
      {{outer, eaves}, {0.0, z + outer}, {-outer, eaves}, {-inner, eaves}, {0.0, z + inner}, {inner, eaves}},
      x - 0.01, x + 0.17);
}

}  // namespace

Lamp make_lamp(LampKind kind) {
  Lamp lamp;
  switch (kind) {
    case LampKind::avenue:
      lamp.mesh = arm_lamp(8.0, 1.9, "lamp_glass");
      lamp.light_position = {2.2, 0.0, 7.95};
      lamp.light = downlight(lamp_color_4000k, 9000.0, 55.0, 83.0, 31.0);
      break;
    case LampKind::street:
      lamp.mesh = arm_lamp(6.25, 1.2, "lamp_glass_warm");
      lamp.light_position = {1.5, 0.0, 6.2};
      lamp.light = downlight(lamp_color_3000k, 6000.0, 55.0, 83.0, 24.0);
      break;
    case LampKind::park: {
      const int metal = material("painted_metal");
      lamp.mesh.box(metal, {-0.05, -0.05, -0.2}, {0.05, 0.05, 3.6});
      lamp.mesh.box(material("lamp_glass"), {-0.13, -0.13, 3.55}, {0.13, 0.13, 3.75});
      lamp.mesh.prism(metal, metal, regular_polygon(6, 0.3), 3.72, 3.8);
      lamp.light_position = {0.0, 0.0, 3.5};
      lamp.light = downlight(lamp_color_4000k, 2500.0, 50.0, 84.0, 15.0);
      break;
    }
    case LampKind::yard:
      lamp.mesh = arm_lamp(5.2, 0.7, "lamp_glass_warm");
      lamp.light_position = {1.0, 0.0, 5.15};
      lamp.light = downlight(lamp_color_3000k, 6000.0, 55.0, 83.0, 24.0);
  }
  return lamp;
}

MeshBuilder make_signal() {
  MeshBuilder mesh;
  mesh.box(material("galvanised_metal"), {-0.06, -0.06, -0.1}, {0.06, 0.06, 3.3});
  mesh.box(material("signal_housing"), {0.05, -0.15, 2.35}, {0.3, 0.15, 3.25});
  add_lens(mesh, "switched_green", 0.3, 2.5);
  add_lens(mesh, "switched_amber", 0.3, 2.8);
  add_lens(mesh, "switched_red", 0.3, 3.1);
  return mesh;
}

MeshBuilder make_walk_signal(bool pole) {
  MeshBuilder mesh;
  if (pole) mesh.box(material("galvanised_metal"), {-0.06, -0.06, -0.1}, {0.06, 0.06, 2.75});
  mesh.box(material("signal_housing"), {0.05, -0.14, 2.1}, {0.22, 0.14, 2.7});
  add_lens(mesh, "switched_green", 0.22, 2.25);
  add_lens(mesh, "switched_red", 0.22, 2.54);
  return mesh;
}

MeshBuilder make_shelter() {
  MeshBuilder mesh;
  const int metal = material("painted_metal"), glass = material("shelter_glass");
  mesh.box(metal, {-0.1, -2.1, 2.4}, {1.5, 2.1, 2.5});
  mesh.box(glass, {-0.03, -2.0, 0.25}, {0.0, 2.0, 2.44});
  for (const double y : {-2.04, 1.98}) mesh.box(metal, {-0.06, y, -0.1}, {0.03, y + 0.06, 2.42});
  mesh.box(metal, {0.05, 1.93, -0.1}, {1.4, 2.07, 0.4});
  mesh.box(material("poster"), {0.1, 1.94, 0.35}, {1.3, 2.06, 2.15});
  mesh.box(material("bench_wood"), {0.1, -1.6, 0.42}, {0.45, 1.2, 0.48});
  mesh.box(metal, {0.2, -0.3, -0.1}, {0.3, 0.3, 0.44});
  return mesh;
}

MeshBuilder make_bin() {
  MeshBuilder mesh;
  mesh.box(material("signal_housing"), {-0.2, -0.25, -0.05}, {0.2, 0.25, 0.9});
  return mesh;
}

}  // namespace greatx::scene::generator
