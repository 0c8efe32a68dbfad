// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "scene/generator/objects/street_furniture.h"

#include <cmath>

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

MeshBuilder make_signal(bool green) {
  MeshBuilder mesh;
  mesh.box(material("galvanised_metal"), {-0.06, -0.06, -0.1}, {0.06, 0.06, 3.3});
  mesh.box(material("signal_housing"), {0.05, -0.17, 2.35}, {0.3, 0.17, 3.35});
  const double z = green ? 2.43 : 3.05;
  mesh.box(material(green ? "signal_green" : "signal_red"), {0.25, -0.1, z}, {0.33, 0.1, z + 0.2});
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
