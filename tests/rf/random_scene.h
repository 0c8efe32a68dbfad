// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Draws small scenes from a seed. A scene can be shifted, turned, subdivided and renumbered. Corners are
// multiples of 2^-10 m, so that a shift by whole metres is exact in fp64 up to 10^9 m.
#pragma once

#include <numeric>
#include <string>
#include <vector>

#include "core/random.h"
#include "tests/support/tiny_scene.h"

namespace greatx::rf::testing {

struct RandomScene {
  struct Face {
    std::vector<test::Triangle> triangles;
    uint32_t material = 0;
  };
  std::string name;
  std::vector<Face> faces;  ///< each face is one facet
  dvec3 transmitter{0.0};   ///< in the same box about the middle of the scene as the receivers
  std::vector<dvec3> receivers;
};

/// Describes the changes to a scene before it is built.
struct Change {
  /// `shift` moves all corners. `origin` is the origin of the local coordinates, in the shifted world.
  dvec3 shift{0.0}, origin{0.0};
  dquat turn{1.0, 0.0, 0.0, 0.0};
  bool split = false;           ///< splits each triangle into four
  std::vector<uint32_t> order;  ///< facet i of the built scene is face order[i]; empty: the original order
};

class SceneDraw {
 public:
  explicit SceneDraw(uint64_t seed) : random_(seed, 0x70726f70u) {}

  RandomScene draw(uint32_t kind, uint32_t receivers) {
    static constexpr const char* names[] = {"triangles", "boxes", "turned boxes", "room", "terrace"};
    made_.name = names[kind];
    const double half = kind == 3 ? 5.0 : 22.0, top = kind == 3 ? 3.5 : 14.0;
    if (kind == 0) triangles(16);
    if (kind != 0 && kind != 3) quad({-32, -32, 0}, {64, 0, 0}, {0, 64, 0});
    if (kind == 1) boxes(4, false);
    if (kind == 2) boxes(4, true);
    if (kind == 3) room();
    if (kind == 4) terrace();
    const auto point = [&] {
      const double x = random_.uniform(-half, half), y = random_.uniform(-half, half);
      return dvec3(x, y, random_.uniform(0.3, top));
    };
    made_.transmitter = point();
    for (uint32_t i = 0; i < receivers; ++i) made_.receivers.push_back(point());
    return made_;
  }

 private:
  double snapped(double low, double high) { return std::round(random_.uniform(low, high) * 1024.0) / 1024.0; }
  /// Returns an index into add_radio_materials. Three of four draws let waves pass.
  uint32_t material() {
    static constexpr uint32_t draws[] = {0, 1, 1, 1, 2, 2, 2, 3};
    return draws[random_.below(8)];
  }

  /// Adds a parallelogram. Its normal is along `along` x `up`.
  void quad(const dvec3& corner, const dvec3& along, const dvec3& up) {
    const dvec3 b = corner + along, c = b + up, d = corner + up;
    made_.faces.push_back({{{corner, b, c}, {corner, c, d}}, material()});
  }
  /// Adds a box on the base u x v with its normals outwards.
  void box(const dvec3& corner, const dvec3& u, const dvec3& v, double height) {
    const dvec3 w(0, 0, height);
    quad(corner, v, u);
    quad(corner + w, u, v);
    quad(corner, u, w);
    quad(corner + v, w, u);
    quad(corner, w, v);
    quad(corner + u, v, w);
  }
  void triangles(int count) {
    for (int i = 0; i < count; ++i) {
      const dvec3 middle(snapped(-18, 18), snapped(-18, 18), snapped(0, 14));
      test::Triangle triangle;
      for (dvec3& corner : triangle) corner = middle + dvec3(snapped(-9, 9), snapped(-9, 9), snapped(-7, 7));
      made_.faces.push_back({{triangle}, material()});
    }
  }
  void boxes(int count, bool turned) {
    for (int i = 0; i < count; ++i) {
      const dvec3 corner(snapped(-20, 14), snapped(-20, 14), 0.0);
      const double length = snapped(3, 9), across = turned ? snapped(-5, 5) : 0.0, share = snapped(0.4, 1.5);
      const dvec3 u(length, across, 0), v(-across * share, length * share, 0);
      box(corner, u, v, snapped(3, 12));
    }
  }
  void room() {
    const dvec3 o(-6, -6, 0), x(12, 0, 0), y(0, 12, 0), z(0, 0, 4);
    quad(o, x, y), quad(o + z, y, x), quad(o, y, z), quad(o + x, z, y), quad(o, z, x), quad(o + y, x, z);
    for (int i = 0; i < 2; ++i)
      box({snapped(-5, 2), snapped(-5, 2), 0.25}, {snapped(0.5, 3), 0, 0}, {0, snapped(0.5, 3), 0},
          snapped(0.5, 3));
  }
  /// Adds houses in a row. Two neighbours share a wall, which exists twice: once for each house, with
  /// opposite normals.
  void terrace() {
    double y = -12.0;
    const double x = snapped(-4, 4), depth = snapped(5, 9), height = snapped(6, 11);
    for (int i = 0; i < 3; ++i) {
      const double width = snapped(5, 9);
      box({x, y, 0}, {depth, 0, 0}, {0, width, 0}, height);
      y += width;
    }
  }

  RandomStream random_;
  RandomScene made_;
};

constexpr uint32_t random_scene_kinds = 5;

inline RandomScene random_scene(uint64_t seed, uint32_t kind, uint32_t receivers) {
  return SceneDraw(seed).draw(kind, receivers);
}

/// Adds the materials concrete ground, thin wall, glass pane and metal.
inline std::vector<uint32_t> add_radio_materials(test::TinyScene& tiny) {
  const auto add = [&](const char* name, double relative, double sigma, double thickness_m) {
    scene::RadioMedium medium;
    medium.source = "test";
    medium.rows.push_back({relative, 0.0, sigma, 0.0, 1e3, 1e15});
    scene::RadioMaterial radio;
    radio.layers.push_back({medium, thickness_m});
    scene::Material material;
    material.name = name;
    material.radio = radio;
    return tiny.material_as(material);
  };
  return {add("ground", 5.24, 0.12, 0.0), add("wall", 3.9, 0.03, 0.2), add("pane", 6.3, 0.01, 0.008),
          add("metal", 1.0, 1e7, 0.0)};
}

inline std::vector<test::Triangle> in_four(const test::Triangle& t) {
  const dvec3 ab = 0.5 * (t[0] + t[1]), bc = 0.5 * (t[1] + t[2]), ca = 0.5 * (t[2] + t[0]);
  return {{t[0], ab, ca}, {ab, t[1], bc}, {ca, bc, t[2]}, {ab, bc, ca}};
}

inline scene::Scene build(const RandomScene& random, const Change& change = {}) {
  test::TinyScene tiny;
  const std::vector<uint32_t> materials = add_radio_materials(tiny);
  std::vector<uint32_t> order = change.order;
  if (order.empty()) {
    order.resize(random.faces.size());
    std::iota(order.begin(), order.end(), 0u);
  }
  for (const uint32_t index : order) {
    const RandomScene::Face& face = random.faces[index];
    std::vector<test::Triangle> triangles;
    for (test::Triangle triangle : face.triangles) {
      for (dvec3& corner : triangle) corner = change.turn * corner + change.shift;
      const std::vector<test::Triangle> pieces = in_four(triangle);
      triangles.insert(triangles.end(), change.split ? pieces.begin() : pieces.end(), pieces.end());
      if (!change.split) triangles.push_back(triangle);
    }
    tiny.object("face " + std::to_string(index), 0, materials[face.material]).face(triangles);
  }
  return tiny.build(change.origin);
}

}  // namespace greatx::rf::testing
