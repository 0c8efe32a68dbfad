// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "scene/generator/objects/trees.h"

#include <array>
#include <cmath>

#include "core/units.h"
#include "scene/generator/mesh/materials.h"
#include "scene/generator/paint/texture_painter.h"

namespace greatx::scene::generator {

namespace {

/// Adds a four-sided trunk that narrows to a point inside the crown. Its sides are triangles, so that each is
/// one plane.
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

/// The unit sphere as three staggered rings between two poles: 48 triangles.
struct Sphere {
  std::vector<dvec3> points;
  std::vector<std::array<size_t, 3>> faces;
};

Sphere make_sphere() {
  constexpr size_t sides = 8;
  Sphere sphere;
  sphere.points.emplace_back(0.0, 0.0, -1.0);
  const std::array<double, 3> heights{-0.64, 0.05, 0.68};
  for (size_t ring = 0; ring < 3; ++ring)
    for (size_t i = 0; i < sides; ++i) {
      const double angle = 2.0 * pi * (static_cast<double>(i) + 0.5 * static_cast<double>(ring)) / sides;
      const double z = heights[ring], r = std::sqrt(1.0 - z * z);
      sphere.points.emplace_back(r * std::cos(angle), r * std::sin(angle), z);
    }
  sphere.points.emplace_back(0.0, 0.0, 1.0);
  const auto at = [](size_t ring, size_t i) { return 1 + ring * sides + i % sides; };
  for (size_t i = 0; i < sides; ++i) {
    sphere.faces.push_back({0, at(0, i + 1), at(0, i)});
    for (size_t ring = 0; ring < 2; ++ring) {
      sphere.faces.push_back({at(ring, i), at(ring, i + 1), at(ring + 1, i)});
      sphere.faces.push_back({at(ring + 1, i), at(ring, i + 1), at(ring + 1, i + 1)});
    }
    sphere.faces.push_back({at(2, i), at(2, i + 1), sphere.points.size() - 1});
  }
  return sphere;
}

/// Describes the shape of a species' crown.
struct Crown {
  const char* leaves;
  double low, high, radius;
  double widest;  ///< height of the greatest width, as a fraction of the crown's height
  double taper;   ///< shape of the top: 0 round, 1 a cone
  double lumps;   ///< relative depth of the gaps between boughs
};

/// Adds a closed body with boughs and gaps.
void add_crown(MeshBuilder& mesh, const Crown& crown, uint32_t seed) {
  static const Sphere sphere = make_sphere();
  const int leaves = material(crown.leaves);
  const double height = crown.high - crown.low, widest = crown.low + crown.widest * height;
  const auto noise = [&](int i, uint32_t k) { return (hash(i, 0, seed + k) % 1001) / 500.0 - 1.0; };
  std::vector<dvec3> points;
  for (size_t i = 0; i < sphere.points.size(); ++i) {
    const dvec3 d = sphere.points[i];
    // Boughs are three waves around the trunk with their own phase. Each corner also moves a little in or
    // out.
    const double around = std::atan2(d.y, d.x);
    const double bough = 0.6 * std::sin(3.0 * around + 6.0 * d.z + noise(-1, 3) * pi) +
                         0.5 * std::sin(5.0 * around - 4.0 * d.z + noise(-2, 3) * pi);
    const double out = 1.0 + crown.lumps * (0.5 * bough + 0.6 * noise(static_cast<int>(i), 1));
    const double up = d.z > 0.0 ? crown.high - widest : widest - crown.low;
    const double slim = d.z > 0.0 ? 1.0 - crown.taper * d.z : 1.0 + 0.12 * d.z;
    points.push_back(
        snap(dvec3(crown.radius * out * slim * d.x, crown.radius * out * slim * d.y,
                   widest + up * d.z * (1.0 + 0.4 * crown.lumps * noise(static_cast<int>(i), 2)))));
  }
  std::vector<dvec3> normals(points.size(), dvec3(0.0));
  for (const auto& face : sphere.faces) {
    const dvec3 area = glm::cross(points[face[1]] - points[face[0]], points[face[2]] - points[face[0]]);
    for (const size_t i : face) normals[i] += area;
  }
  for (const auto& face : sphere.faces) {
    std::array<dvec3, 3> p, n;
    std::array<dvec2, 3> uv;
    const dvec3 middle = (sphere.points[face[0]] + sphere.points[face[1]] + sphere.points[face[2]]) / 3.0;
    const double around = std::atan2(middle.y, middle.x);
    for (size_t k = 0; k < 3; ++k) {
      p[k] = points[face[k]];
      const dvec3 flat =
          glm::normalize(glm::cross(points[face[1]] - points[face[0]], points[face[2]] - points[face[0]]));
      n[k] = glm::normalize(normals[face[k]]);
      n[k] = glm::normalize(n[k] + 0.35 * flat);
      if (glm::dot(n[k], flat) < 0.1) n[k] = flat;
      const dvec3 d = sphere.points[face[k]];
      // The angle around the trunk is unwrapped next to the middle of the face. At a pole it is that of the
      // face.
      double angle = std::abs(d.z) > 0.999 ? around : std::atan2(d.y, d.x);
      if (angle - around > pi) angle -= 2.0 * pi;
      if (around - angle > pi) angle += 2.0 * pi;
      // Tops and undersides are mapped from above, sides from around.
      uv[k] = std::abs(flat.z) > 0.75 ? dvec2(p[k].x, p[k].y) / 3.0
                                      : dvec2(angle * crown.radius / 3.0, -p[k].z / 3.0);
    }
    mesh.triangle(leaves, p, n, uv);
  }
}

struct Species {
  Crown crown;
  double trunk_m;
};

const std::array<Species, tree_species>& species() {
  static const std::array<Species, tree_species> list{{
      {{"leaves_green", 2.2, 7.4, 2.1, 0.42, 0.15, 0.26}, 0.20},    // linden
      {{"leaves_light", 2.3, 6.9, 2.4, 0.45, 0.0, 0.30}, 0.20},     // maple
      {{"leaves_olive", 2.1, 6.4, 2.75, 0.4, 0.0, 0.34}, 0.26},     // oak
      {{"leaves_dark", 2.4, 7.8, 2.2, 0.5, 0.05, 0.28}, 0.22},      // plane
      {{"leaves_green", 1.2, 10.6, 1.15, 0.35, 0.45, 0.22}, 0.18},  // Lombardy poplar
      {{"leaves_copper", 2.0, 6.0, 2.2, 0.45, 0.0, 0.24}, 0.18},    // copper beech
  }};
  return list;
}

}  // namespace

MeshBuilder make_tree(int kind, int shape) {
  const Species& s = species()[static_cast<size_t>(kind)];
  MeshBuilder mesh;
  add_trunk(mesh, s.trunk_m, s.crown.low + 0.45 * (s.crown.high - s.crown.low));
  add_crown(mesh, s.crown, 900u + 16u * static_cast<uint32_t>(kind) + static_cast<uint32_t>(shape));
  return mesh;
}

MeshBuilder make_conifer() {
  MeshBuilder mesh;
  const int needles = material("needles");
  add_trunk(mesh, 0.2, 4.0);
  constexpr int sides = 8;
  for (int tier = 0; tier < 4; ++tier) {
    const double low = 1.0 + 2.0 * tier, high = low + 3.0, radius = 2.15 - 0.45 * tier;
    std::vector<dvec2> skirt = regular_polygon(sides, radius, dvec2(0.0), 0.35 * tier);
    for (size_t i = 0; i < skirt.size(); ++i)  // boughs and gaps
      skirt[i] = snap(skirt[i] * (i % 2 == 0 ? 1.0 : 0.78));
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

}  // namespace greatx::scene::generator
