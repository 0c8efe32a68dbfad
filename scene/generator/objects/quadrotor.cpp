// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include <array>
#include <cmath>

#include "core/units.h"
#include "scene/generator/mesh/materials.h"
#include "scene/generator/objects/objects.h"

namespace greatx::scene::generator {

namespace {

/// Returns a rectangle with its corners cut by `cut`, counter-clockwise.
std::vector<dvec2> chamfered(double half_x, double half_y, double cut, double shift_x = 0.0) {
  std::vector<dvec2> corners{{half_x - cut, -half_y},  {half_x, -half_y + cut}, {half_x, half_y - cut},
                             {half_x - cut, half_y},   {-half_x + cut, half_y}, {-half_x, half_y - cut},
                             {-half_x, -half_y + cut}, {-half_x + cut, -half_y}};
  for (dvec2& c : corners) c = snap(c + dvec2(shift_x, 0.0));
  return corners;
}

void add_landing_gear(MeshBuilder& body, double d) {
  const int dark = material("carbon_fibre");
  const double w = std::max(0.004, 0.014 * d);
  for (const double side : {-1.0, 1.0}) {
    const double y = side * 0.13 * d;
    body.box(dark, {-0.2 * d, y - w, -0.2 * d}, {0.2 * d, y + w, -0.2 * d + 2 * w});
    for (const double x : {-0.1 * d, 0.1 * d}) {
      // The legs go up into the hull, within its outline.
      const double inner = side * 0.085 * d;
      const double y0 = std::min(inner, y) - 0.5 * w, y1 = std::max(inner, y) + 0.5 * w;
      body.box(dark, {x - 0.7 * w, y - 0.6 * w, -0.2 * d + w}, {x + 0.7 * w, y + 0.6 * w, -0.055 * d});
      body.box(dark, {x - 0.8 * w, y0, -0.065 * d}, {x + 0.8 * w, y1, -0.04 * d});
    }
  }
}

MeshBuilder make_rotor(double d) {
  MeshBuilder rotor;
  const double r = 0.3 * d, thickness = std::max(0.002, 0.006 * d);
  const int blade_material = material("carbon_fibre");
  rotor.prism(material("motor_metal"), material("motor_metal"), regular_polygon(8, std::max(0.006, 0.02 * d)),
              -0.01 * d, 0.018 * d);
  for (const double side : {-1.0, 1.0}) {
    // blade: root, widest at a third of the length, narrow tip
    std::vector<dvec2> blade{{0.008 * d, -0.008 * d}, {0.33 * r, -0.03 * d}, {0.97 * r, -0.014 * d}, {r, 0.0},
                             {0.97 * r, 0.008 * d},   {0.33 * r, 0.016 * d}, {0.008 * d, 0.008 * d}};
    for (dvec2& p : blade) p = snap(side * p);
    rotor.prism(blade_material, blade_material, blade, 0.0, thickness);
  }
  return rotor;
}

}  // namespace

Quadrotor make_quadrotor(double d) {
  Quadrotor result;
  MeshBuilder& body = result.body;
  const int shell = material("uav_shell"), dark = material("uav_dark"), carbon = material("carbon_fibre");
  body.prism(shell, shell, chamfered(0.19 * d, 0.11 * d, 0.05 * d), -0.055 * d, 0.03 * d);
  body.prism(dark, dark, chamfered(0.14 * d, 0.08 * d, 0.04 * d, -0.02 * d), 0.025 * d, 0.06 * d);
  body.prism(material("uav_accent"), material("uav_accent"),
             chamfered(0.06 * d, 0.03 * d, 0.015 * d, -0.05 * d), 0.05 * d, 0.068 * d);
  // arms from within the hull to the motors
  const double reach = 0.5 * d, half = std::max(0.005, 0.018 * d);
  for (int i = 0; i < 4; ++i) {
    const double yaw = pi / 4 - pi / 2 * i;  // front left, front right, rear right, rear left
    const dvec3 motor = snap(dvec3(reach * std::cos(yaw), reach * std::sin(yaw), 0.0));
    MeshBuilder arm;
    arm.box(carbon, {0.07 * d, -half, -half - 0.008 * d}, {reach, half, half - 0.008 * d});
    body.append(arm, dvec3(0.0), yaw);
    const double motor_radius = std::max(0.01, 0.036 * d);
    body.prism(material("motor_metal"), dark, regular_polygon(10, motor_radius, dvec2(motor)), -0.035 * d,
               0.035 * d);
    // Navigation lights are red on the left (port) and green on the right.
    body.prism(material(i == 0 || i == 3 ? "navigation_red" : "navigation_green"), dark,
               regular_polygon(6, 0.7 * motor_radius, dvec2(motor)), -0.046 * d, -0.03 * d);
    result.rotor_centers.push_back(snap(motor + dvec3(0.0, 0.0, 0.044 * d)));
  }
  add_landing_gear(body, d);
  // camera under the nose
  body.box(dark, {0.13 * d, -0.012 * d, -0.09 * d}, {0.15 * d, 0.012 * d, -0.05 * d});
  body.box(dark, {0.115 * d, -0.035 * d, -0.125 * d}, {0.185 * d, 0.035 * d, -0.075 * d});
  body.box(material("camera_glass"), {0.17 * d, -0.022 * d, -0.118 * d}, {0.192 * d, 0.022 * d, -0.082 * d});
  result.rotor = make_rotor(d);
  return result;
}

}  // namespace greatx::scene::generator
