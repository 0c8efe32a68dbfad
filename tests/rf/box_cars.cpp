// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// A hatchback and a van of boxes and prisms that stick in one another: few and flat facets, as brute force
// over all pairs of facets needs them.
#include "tests/rf/box_cars.h"

#include <array>

#include "core/units.h"
#include "scene/generator/mesh/materials.h"

namespace greatx::rf::testing {

using namespace scene::generator;

namespace {

/// Adds a pair of wheels as one octagonal prism from side to side. The body hides the part within it.
void add_axle(MeshBuilder& mesh, double x, double radius, double half_track) {
  const auto disc = [&](double r) {
    std::vector<dvec2> profile = regular_polygon(8, r, dvec2(x, radius), pi / 8);
    return profile;
  };
  mesh.prism_along_y(material("tyre"), disc(radius), -half_track, half_track);
  mesh.prism_along_y(material("wheel_rim"), disc(0.6 * radius), -half_track - 0.015, half_track + 0.015);
}

/// Adds a frustum with glass all around and a roof. Edges of opposite faces are parallel, so that every face
/// is planar.
void add_cabin(MeshBuilder& mesh, int roof, double z0, double z1, const dvec2& x0, const dvec2& x1, double y0,
               double y1) {
  const int glass = material("car_glass");
  const std::array<dvec3, 4> low{dvec3(x0.x, -y0, z0), dvec3(x0.y, -y0, z0), dvec3(x0.y, y0, z0),
                                 dvec3(x0.x, y0, z0)};
  const std::array<dvec3, 4> high{dvec3(x1.x, -y1, z1), dvec3(x1.y, -y1, z1), dvec3(x1.y, y1, z1),
                                  dvec3(x1.x, y1, z1)};
  for (size_t i = 0; i < 4; ++i) mesh.quad(glass, low[i], low[(i + 1) % 4], high[(i + 1) % 4], high[i]);
  mesh.quad(roof, high[0], high[1], high[2], high[3]);
  mesh.quad(roof, low[3], low[2], low[1], low[0]);
}

/// Adds head lights at height z.x and tail lights at z.y, slightly proud of the body.
void add_lights(MeshBuilder& mesh, double front, double rear, double half_width, const dvec2& z) {
  const int head = material("headlight"), tail = material("tail_light");
  for (const double side : {-1.0, 1.0}) {
    const double y0 = side > 0 ? half_width - 0.42 : -half_width + 0.04;
    mesh.box(head, {front - 0.2, y0, z.x}, {front + 0.015, y0 + 0.38, z.x + 0.11});
    mesh.box(tail, {rear - 0.015, y0, z.y}, {rear + 0.15, y0 + 0.38, z.y + 0.14});
  }
}

/// Adds a closed box that leans: its floor [low, high] is at height low.z, and its top is moved by `shift`.
void add_leaning_box(MeshBuilder& mesh, int material, const dvec3& low, const dvec2& high,
                     const dvec3& shift) {
  const std::array<dvec3, 4> floor{low, dvec3(high.x, low.y, low.z), dvec3(high, low.z),
                                   dvec3(low.x, high.y, low.z)};
  for (size_t i = 0; i < 4; ++i) {
    const dvec3 a = floor[i], b = floor[(i + 1) % 4];
    mesh.quad(material, a, b, b + shift, a + shift);
  }
  mesh.quad(material, floor[3], floor[2], floor[1], floor[0]);
  mesh.quad(material, floor[0] + shift, floor[1] + shift, floor[2] + shift, floor[3] + shift);
}

/// Adds the pillars of the hatchback's cabin, on its glass, and the mirrors.
void add_pillars(MeshBuilder& mesh, int paint) {
  struct Pillar {
    double x0, x1, lean;
  };
  for (const Pillar& p : {Pillar{1.02, 1.11, -0.79}, Pillar{-0.33, -0.25, 0.0}, Pillar{-1.88, -1.7, 0.347}})
    for (const double side : {-1.0, 1.0}) {
      const double y0 = side > 0 ? 0.76 : -0.835;
      add_leaning_box(mesh, paint, {p.x0, y0, 0.91}, {p.x1, y0 + 0.075}, {p.lean, -0.193 * side, 0.53});
    }
  for (const double y : {-1.0, 0.84}) mesh.box(paint, {0.72, y, 0.93}, {0.84, y + 0.16, 1.06});
}

MeshBuilder make_hatchback(int paint) {
  MeshBuilder mesh;
  const std::vector<dvec2> profile{{-1.93, 0.24}, {1.9, 0.24},   {1.98, 0.36},  {1.98, 0.62}, {1.86, 0.76},
                                   {0.98, 0.93},  {-1.82, 0.97}, {-1.98, 0.86}, {-1.98, 0.4}};
  mesh.prism_along_y(paint, profile, -0.86, 0.86);
  add_cabin(mesh, paint, 0.90, 1.45, {-1.86, 1.1}, {-1.5, 0.28}, 0.82, 0.62);
  add_axle(mesh, 1.22, 0.31, 0.875);
  add_axle(mesh, -1.26, 0.31, 0.875);
  add_lights(mesh, 1.98, -1.98, 0.86, {0.485, 0.67});
  mesh.box(material("bumper"), {1.8, -0.7, 0.30}, {2.01, 0.7, 0.44});
  mesh.box(material("bumper"), {-2.01, -0.7, 0.30}, {-1.8, 0.7, 0.44});
  mesh.box(material("number_plate"), {-1.99, -0.26, 0.52}, {-1.9, 0.26, 0.63});
  add_pillars(mesh, paint);
  mesh.box(paint, {-1.52, -0.635, 1.41}, {0.31, 0.635, 1.47});
  return mesh;
}

MeshBuilder make_van(int paint) {
  MeshBuilder mesh;
  const std::vector<dvec2> profile{{-2.55, 0.28}, {2.5, 0.28},  {2.62, 0.42}, {2.62, 0.78}, {2.5, 0.98},
                                   {1.72, 1.16},  {1.38, 1.16}, {1.1, 2.18},  {-2.6, 2.2},  {-2.62, 0.45}};
  mesh.prism_along_y(paint, profile, -0.96, 0.96);
  add_cabin(mesh, paint, 1.12, 2.05, {0.2, 1.74}, {0.2, 1.18}, 0.975, 0.965);
  add_axle(mesh, 1.68, 0.34, 0.975);
  add_axle(mesh, -1.62, 0.34, 0.975);
  add_lights(mesh, 2.62, -2.62, 0.96, {0.62, 0.9});
  for (const double side : {-1.0, 1.0}) {  // sills and mirrors
    const double y0 = side > 0 ? 0.9 : -0.972;
    mesh.box(material("bumper"), {-1.2, y0, 0.3}, {1.25, y0 + 0.072, 0.4});
    mesh.box(material("bumper"), {1.3, side > 0 ? 0.9 : -1.14, 1.2}, {1.4, side > 0 ? 1.14 : -0.9, 1.45});
  }
  mesh.box(material("bumper"), {2.4, -0.85, 0.32}, {2.66, 0.85, 0.5});
  mesh.box(material("bumper"), {-2.66, -0.85, 0.32}, {-2.4, 0.85, 0.5});
  mesh.box(material("number_plate"), {-2.635, -0.26, 0.6}, {-2.5, 0.26, 0.71});
  mesh.box(material("car_glass"), {-2.63, -0.75, 1.3}, {-2.5, 0.75, 1.9});
  return mesh;
}

}  // namespace

MeshBuilder make_box_car(const std::string& variant) {
  return variant == "van" ? make_van(material("car_paint_white")) : make_hatchback(material("car_paint_red"));
}

}  // namespace greatx::rf::testing
