// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "scene/generator/objects/vehicle_parts.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "core/units.h"
#include "scene/generator/mesh/materials.h"
#include "scene/generator/objects/smooth_mesh.h"

namespace greatx::scene::generator {

namespace {

/// Returns the corners of a wheel in its plane, from the one that touches the ground. Seen from -y they are
/// counter-clockwise.
std::vector<dvec2> wheel_outline(int count, double radius, const dvec2& center) {
  std::vector<dvec2> corners = regular_polygon(count, radius, center, -pi / 2);
  for (dvec2& corner : corners) corner = snap(corner);
  return corners;
}

/// Adds a face of a wheel at y, with the picture of a wheel. It looks to +y if `left`. Its hub lies `dish`
/// farther inwards: a level disc would be a mirror to a radar that is exactly abeam.
void add_wheel_face(MeshBuilder& mesh, int material, const std::vector<dvec2>& outline, const dvec2& center,
                    double radius, double y, bool left, double dish = 0.0) {
  const double outwards = left ? 1.0 : -1.0;
  const auto uv = [&](const dvec2& p) { return 0.5 + 0.5 * (p - center) / radius; };
  const auto add = [&](const dvec3& a, const dvec3& b, const dvec3& c) {
    const std::array<dvec2, 3> at{uv({a.x, a.z}), uv({b.x, b.z}), uv({c.x, c.z})};
    if (left)
      mesh.triangle(material, {a, c, b}, {at[0], at[2], at[1]});
    else
      mesh.triangle(material, {a, b, c}, at);
  };
  const auto corner = [&](size_t i) {
    const dvec2& p = outline[i % outline.size()];
    return dvec3(p.x, y, p.y);
  };
  if (dish > 0.0) {
    const dvec3 hub(center.x, y - outwards * dish, center.y);
    for (size_t i = 0; i < outline.size(); ++i) add(hub, corner(i), corner(i + 1));
  } else {
    for (size_t i = 1; i + 1 < outline.size(); ++i) add(corner(0), corner(i), corner(i + 1));
  }
}

void add_tread(SmoothMesh& mesh, const std::vector<dvec2>& outline, double y0, double y1) {
  const int tyre = material("tyre");
  for (size_t i = 0; i < outline.size(); ++i) {
    const dvec2 a = outline[i], b = outline[(i + 1) % outline.size()];
    mesh.quad(tyre, dvec3(a.x, y0, a.y), dvec3(a.x, y1, a.y), dvec3(b.x, y1, b.y), dvec3(b.x, y0, b.y));
  }
}

}  // namespace

MeshBuilder make_wheel(double radius, double width, int face, bool left) {
  MeshBuilder mesh;
  const int corners = width < 0.15 ? 10 : radius > 0.5 ? 12 : radius > 0.4 ? 14 : 16;
  const std::vector<dvec2> outline = wheel_outline(corners, radius, dvec2(0.0));
  SmoothMesh tread;
  add_tread(tread, outline, -0.5 * width, 0.5 * width);
  tread.add_to(mesh, 0.8);
  add_wheel_face(mesh, face, outline, dvec2(0.0), radius, (left ? 0.5 : -0.5) * width, left, 0.1 * radius);
  add_wheel_face(mesh, material("tyre"), outline, dvec2(0.0), radius, (left ? -0.5 : 0.5) * width, !left);
  return mesh;
}

MeshBuilder make_motor_wheel(double radius, double width) {
  MeshBuilder mesh;
  const std::vector<dvec2> outline = wheel_outline(16, radius, dvec2(0.0));
  SmoothMesh tread;
  add_tread(tread, outline, -0.5 * width, 0.5 * width);
  tread.add_to(mesh, 0.8);
  for (const bool left : {true, false})
    add_wheel_face(mesh, material("wheel_alloy"), outline, dvec2(0.0), radius, (left ? 0.5 : -0.5) * width,
                   left, 0.1 * radius);
  return mesh;
}

void add_axle(MeshBuilder& mesh, const dvec3& left_hub, double radius, double width, int face) {
  const dvec2 center(left_hub.x, left_hub.z);
  const double y = snap(left_hub.y + 0.5 * width);
  const std::vector<dvec2> outline = wheel_outline(8, radius, center);
  SmoothMesh tread;
  add_tread(tread, outline, -y, y);
  tread.add_to(mesh, 0.8);
  add_wheel_face(mesh, face, outline, center, radius, y, true);
  add_wheel_face(mesh, face, outline, center, radius, -y, false);
}

void add_boxes(MeshBuilder& mesh, int material, const dvec3& low, const dvec3& high) {
  mesh.box(material, low, high);
  mesh.box(material, {low.x, -high.y, low.z}, {high.x, -low.y, high.z});
}

void add_indicators(MeshBuilder& mesh, const dvec3& low, const dvec3& high) {
  mesh.box(material("switched_left"), low, high);
  mesh.box(material("switched_right"), {low.x, -high.y, low.z}, {high.x, -low.y, high.z});
}

void add_plate(MeshBuilder& mesh, double x, double z, bool front) {
  const double back = front ? x - 0.06 : x + 0.06;
  mesh.box(material("number_plate"), {std::min(x, back), -0.26, z - 0.055},
           {std::max(x, back), 0.26, z + 0.055});
}

namespace {

/// Returns the low beam. Its light ends at 35 degrees from the axis.
LightSpec low_beam(double peak_cd) {
  return {.color = head_lamp_color,
          .intensity_cd = peak_cd,
          .range_m = peak_cd > 2000.0 ? 60.0 : 25.0,
          .inner_cone = 20.0 * pi / 180.0,
          .outer_cone = 35.0 * pi / 180.0,
          .passing_beam = true};
}

/// Returns the light of both tail lights together, behind the car. Position lights give some 5 cd each.
LightSpec tail_glow() {
  // signal red, luminance 1
  return {.color = vec3(4.6f, 0.025f, 0.055f), .intensity_cd = 5.0, .range_m = 4.0};
}

}  // namespace

void add_vehicle_lights(SceneWriter& writer, const VehicleBody& body, int root) {
  const int beam = writer.add_light(low_beam(body.beam_cd)), glow = writer.add_light(tail_glow());
  const double tilt = std::atan(0.01);  // the elbow of the cut-off lies 1 % below the horizon
  const auto add = [&](const std::vector<dvec3>& lamps, const std::string& name, double ahead, int light,
                       const dvec3& shine) {
    for (const dvec3& lamp : lamps)
      for (const double side : {1.0, -1.0}) {
        if (side < 0.0 && lamp.y == 0.0) continue;
        const char* const suffix = lamp.y == 0.0 ? "" : side > 0.0 ? "_left" : "_right";
        writer.add_node({.name = name + suffix,
                         .position = lamp + dvec3(ahead, (side - 1.0) * lamp.y, 0.0),
                         .parent = root,
                         .light = light,
                         .shine = shine});
      }
  };
  add(body.head_lamps, "head_lamp", 0.03, beam, {std::cos(tilt), 0.0, -std::sin(tilt)});
  add(body.tail_lamps, "tail_lamp", -0.05, glow, dvec3(0.0));
}

}  // namespace greatx::scene::generator
