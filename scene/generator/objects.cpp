// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "scene/generator/objects.h"

#include <array>
#include <cmath>

#include "core/units.h"
#include "scene/generator/canvas.h"
#include "scene/generator/materials.h"

namespace greatx::scene::generator {

namespace {

/// A four-sided trunk that narrows to a point inside the crown: triangles, so that each side is one plane.
void add_trunk(MeshBuilder& mesh, double radius, double top) {
  const int bark = material("bark");
  const std::vector<dvec2> foot = regular_polygon(4, radius, dvec2(0.0), 0.4);
  for (size_t i = 0; i < foot.size(); ++i) {
    const dvec2 a = foot[i], b = foot[(i + 1) % foot.size()];
    mesh.triangle(bark, {dvec3(a, -0.2), dvec3(b, -0.2), dvec3(0, 0, top)},
                  {dvec2(0.0, top), dvec2(0.4, top), dvec2(0.2, 0.0)});
  }
  mesh.flat_polygon(bark, foot, -0.2, false);
}

struct CrownPoint {
  dvec3 position, normal;
  double v;
};

/// A closed blob of two rings and two tips, shaded smoothly; `center_z` is where it is widest.
void add_crown(MeshBuilder& mesh, int material, int shape, double low, double high, double radius) {
  constexpr int sides = 6;
  const double center_z = 0.55 * low + 0.45 * high;
  const auto jitter = [&](int i, int k) {
    return (hash(i, k, static_cast<uint32_t>(shape)) % 1001) / 500.0 - 1.0;
  };
  const auto point = [&](int ring, int side) {
    const double angle = 2.0 * pi * (side % sides + 0.5 * ring) / sides;
    const double r = radius * (ring == 0 ? 0.97 : 0.86) * (1.0 + 0.14 * jitter(side % sides, ring));
    const double z = (ring == 0 ? low + 0.2 * (high - low) : low + 0.68 * (high - low)) +
                     0.08 * (high - low) * jitter(side % sides, ring + 2);
    return dvec3(r * std::cos(angle), r * std::sin(angle), z);
  };
  const auto normal = [&](const dvec3& p) {
    return glm::normalize(dvec3(dvec2(p) / radius, (p.z - center_z) / (0.5 * (high - low))));
  };
  const dvec3 bottom(0, 0, low), top(0.1 * jitter(0, 5), 0.1 * jitter(0, 6), high);
  const auto face = [&](const std::array<dvec3, 3>& p, const std::array<dvec2, 3>& uv) {
    mesh.triangle(material, p, {normal(p[0]), normal(p[1]), normal(p[2])}, uv);
  };
  for (int i = 0; i < sides; ++i) {
    const dvec3 a = point(0, i), b = point(0, i + 1), c = point(1, i), d = point(1, i + 1);
    const double u = 3.0 * i / sides, step = 3.0 / sides;
    face({bottom, b, a}, {dvec2(u + step / 2, 2.0), dvec2(u + step, 1.5), dvec2(u, 1.5)});
    face({a, b, c}, {dvec2(u, 1.5), dvec2(u + step, 1.5), dvec2(u + step / 2, 0.7)});
    face({c, b, d}, {dvec2(u + step / 2, 0.7), dvec2(u + step, 1.5), dvec2(u + 1.5 * step, 0.7)});
    face({c, d, top}, {dvec2(u + step / 2, 0.7), dvec2(u + 1.5 * step, 0.7), dvec2(u + step, 0.0)});
  }
}

}  // namespace

MeshBuilder make_tree(int shape) {
  MeshBuilder mesh;
  const std::array<const char*, 3> colors{"leaves_green", "leaves_dark", "leaves_light"};
  add_trunk(mesh, 0.2, 4.6);
  add_crown(mesh, material(colors[static_cast<size_t>(shape) % 3]), 900 + shape, 2.1, 6.6 + 0.4 * (shape % 3),
            2.05 + 0.15 * (shape % 2));
  return mesh;
}

MeshBuilder make_conifer() {
  MeshBuilder mesh;
  const int needles = material("leaves_dark");
  add_trunk(mesh, 0.2, 4.0);
  constexpr int sides = 7;
  for (int tier = 0; tier < 3; ++tier) {
    const double low = 1.2 + 2.3 * tier, high = low + 3.4, radius = 2.1 - 0.55 * tier;
    const std::vector<dvec2> skirt = regular_polygon(sides, radius, dvec2(0.0), 0.35 * tier);
    for (int i = 0; i < sides; ++i) {
      const dvec2 a = skirt[static_cast<size_t>(i)], b = skirt[static_cast<size_t>((i + 1) % sides)];
      const dvec3 na = glm::normalize(dvec3(a, 0.6 * radius)), nb = glm::normalize(dvec3(b, 0.6 * radius));
      mesh.triangle(needles, {dvec3(a, low), dvec3(b, low), dvec3(0, 0, high)},
                    {na, nb, glm::normalize(na + nb)},
                    {dvec2(2.0 * i / sides, 1.0), dvec2(2.0 * (i + 1) / sides, 1.0),
                     dvec2((2.0 * i + 1) / sides, 0.0)});
    }
    mesh.flat_polygon(needles, skirt, low, false);
  }
  return mesh;
}

MeshBuilder make_lamp() {
  MeshBuilder mesh;
  const int metal = material("painted_metal");
  mesh.box(metal, {-0.07, -0.07, -0.1}, {0.07, 0.07, 6.42});
  mesh.box(metal, {0.02, -0.04, 6.33}, {1.25, 0.04, 6.40});
  mesh.box(metal, {1.15, -0.16, 6.29}, {1.85, 0.16, 6.43});
  mesh.box(material("lamp_glass"), {1.2, -0.12, 6.25}, {1.8, 0.12, 6.31});
  return mesh;
}

MeshBuilder make_bench() {
  MeshBuilder mesh;
  const int wood = material("bench_wood"), metal = material("painted_metal");
  mesh.box(wood, {-0.9, -0.22, 0.42}, {0.9, 0.22, 0.47});
  mesh.box(wood, {-0.9, 0.18, 0.55}, {0.9, 0.215, 0.95});
  for (const double x : {-0.75, 0.69}) mesh.box(metal, {x, -0.18, -0.05}, {x + 0.06, 0.23, 0.9});
  return mesh;
}

namespace {

/// A wheel pair as one octagonal prism from side to side; what lies within the body is hidden.
void add_axle(MeshBuilder& mesh, double x, double radius, double half_track, bool rims) {
  const auto disc = [&](double r) {
    std::vector<dvec2> profile = regular_polygon(8, r, dvec2(x, radius), pi / 8);
    return profile;
  };
  mesh.prism_along_y(material("tyre"), disc(radius), -half_track, half_track);
  if (rims)
    mesh.prism_along_y(material("wheel_rim"), disc(0.6 * radius), -half_track - 0.015, half_track + 0.015);
}

/// A frustum with glass all round and a roof; edges of opposite faces are parallel, so every face is planar.
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

/// Head lights at z.x, tail lights at z.y, a little proud of the body.
void add_lights(MeshBuilder& mesh, double front, double rear, double half_width, const dvec2& z) {
  for (const double side : {-1.0, 1.0}) {
    const double y0 = side > 0 ? half_width - 0.42 : -half_width + 0.04;
    mesh.box(material("headlight"), {front - 0.2, y0, z.x}, {front + 0.015, y0 + 0.38, z.x + 0.11});
    mesh.box(material("tail_light"), {rear - 0.015, y0, z.y}, {rear + 0.15, y0 + 0.38, z.y + 0.14});
  }
}

/// A closed box that leans: its floor [low, high] at height low.z, moved by `shift` at the top.
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

/// Pillars of the hatchback's cabin, on its glass, and mirrors.
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

MeshBuilder make_hatchback(int paint, bool detailed) {
  MeshBuilder mesh;
  const std::vector<dvec2> profile{{-1.93, 0.24}, {1.9, 0.24},   {1.98, 0.36},  {1.98, 0.62}, {1.86, 0.76},
                                   {0.98, 0.93},  {-1.82, 0.97}, {-1.98, 0.86}, {-1.98, 0.4}};
  mesh.prism_along_y(paint, profile, -0.86, 0.86);
  add_cabin(mesh, paint, 0.90, 1.45, {-1.86, 1.1}, {-1.5, 0.28}, 0.82, 0.62);
  add_axle(mesh, 1.22, 0.31, 0.875, detailed);
  add_axle(mesh, -1.26, 0.31, 0.875, detailed);
  if (!detailed) return mesh;
  add_lights(mesh, 1.98, -1.98, 0.86, {0.485, 0.67});
  mesh.box(material("bumper"), {1.8, -0.7, 0.30}, {2.01, 0.7, 0.44});
  mesh.box(material("bumper"), {-2.01, -0.7, 0.30}, {-1.8, 0.7, 0.44});
  mesh.box(material("number_plate"), {-1.99, -0.26, 0.52}, {-1.9, 0.26, 0.63});
  add_pillars(mesh, paint);
  mesh.box(paint, {-1.52, -0.635, 1.41}, {0.31, 0.635, 1.47});
  return mesh;
}

MeshBuilder make_van(int paint, bool detailed) {
  MeshBuilder mesh;
  const std::vector<dvec2> profile{{-2.55, 0.28}, {2.5, 0.28},  {2.62, 0.42}, {2.62, 0.78}, {2.5, 0.98},
                                   {1.72, 1.16},  {1.38, 1.16}, {1.1, 2.18},  {-2.6, 2.2},  {-2.62, 0.45}};
  mesh.prism_along_y(paint, profile, -0.96, 0.96);
  add_cabin(mesh, paint, 1.12, 2.05, {0.2, 1.74}, {0.2, 1.18}, 0.975, 0.965);
  add_axle(mesh, 1.68, 0.34, 0.975, detailed);
  add_axle(mesh, -1.62, 0.34, 0.975, detailed);
  if (!detailed) return mesh;
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

MeshBuilder make_car(const std::string& variant, const std::string& paint, bool detailed) {
  return variant == "van" ? make_van(material(paint), detailed) : make_hatchback(material(paint), detailed);
}

MeshBuilder make_mast() {
  MeshBuilder mesh;
  const int steel = material("galvanised_metal"), dark = material("painted_metal");
  // Foundation and cabinet.
  mesh.prism(material("concrete"), material("concrete"), regular_polygon(8, 1.5, dvec2(0.0), pi / 8), -0.5,
             0.25);
  mesh.box(material("radome"), {1.7, -0.6, -0.1}, {2.4, 0.6, 1.7});
  // Three sections of pole, each narrower than the one below, with flanges between.
  const std::array<double, 4> levels{0.1, 8.5, 16.5, 24.2};
  for (size_t i = 0; i < 3; ++i) {
    const double radius = 0.42 - 0.09 * static_cast<double>(i);
    mesh.prism(steel, steel, regular_polygon(10, radius), levels[i] - (i == 0 ? 0.0 : 0.05), levels[i + 1]);
    mesh.prism(steel, steel, regular_polygon(10, radius + 0.1, dvec2(0.0), 0.2),
               levels[i] + (i == 0 ? 0.1 : -0.08), levels[i] + (i == 0 ? 0.22 : 0.08));
  }
  // Ladder: two rails and rungs, on the side of the cabinet.
  for (const double y : {-0.22, 0.18}) mesh.box(dark, {0.5, y, 0.3}, {0.54, y + 0.04, 23.9});
  for (int rung = 0; rung < 24; ++rung) {
    const double z = 0.8 + 0.95 * rung;
    mesh.box(dark, {0.505, -0.2, z}, {0.535, 0.2, z + 0.03});
  }
  // Three panel antennas on brackets, 120 degrees apart, with a remote radio unit behind each.
  for (int sector = 0; sector < 3; ++sector) {
    MeshBuilder arm;
    arm.box(material("radome"), {0.95, -0.2, 21.2}, {1.12, 0.2, 23.4});
    for (const double z : {21.6, 22.9}) arm.box(dark, {0.1, -0.05, z}, {0.98, 0.05, z + 0.1});
    arm.box(steel, {0.84, -0.035, 20.9}, {0.91, 0.035, 23.7});
    arm.box(material("uav_shell"), {0.5, -0.17, 21.9}, {0.78, 0.17, 22.5});
    mesh.append(arm, dvec3(0.0), pi / 3 + 2.0 * pi * sector / 3);
  }
  // The top platform and its low rail.
  mesh.prism(steel, steel, regular_polygon(8, 0.95, dvec2(0.0), pi / 8), 24.1, 24.18);
  const std::vector<dvec2> posts = regular_polygon(8, 0.86, dvec2(0.0), pi / 8);
  for (const dvec2& p : posts) mesh.box(dark, dvec3(p - 0.02, 24.12), dvec3(p + 0.02, 24.5));
  mesh.box(material("aviation_light"), {-0.08, -0.08, 24.19}, {0.08, 0.08, 24.35});
  return mesh;
}

}  // namespace greatx::scene::generator
