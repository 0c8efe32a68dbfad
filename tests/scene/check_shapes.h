// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Makes the shapes of the tests of scene/check, with z up.
#pragma once

#include <cmath>
#include <map>
#include <utility>
#include <vector>

#include "scene/check/check.h"
#include "tests/scene/gltf_writer.h"

namespace greatx::scene::test {

/// Triangles with z up.
struct Shape {
  std::vector<dvec3> corners;
  std::vector<uint32_t> indices;

  size_t count() const { return indices.size() / 3; }
  dvec3 corner(size_t triangle, size_t i) const { return corners[indices[3 * triangle + i]]; }
  dvec3 center(size_t triangle) const {
    return (corner(triangle, 0) + corner(triangle, 1) + corner(triangle, 2)) / 3.0;
  }
  void triangle(const dvec3& a, const dvec3& b, const dvec3& c) {
    for (const dvec3& p : {a, b, c}) {
      indices.push_back(static_cast<uint32_t>(corners.size()));
      corners.push_back(p);
    }
  }
  void quad(const dvec3& a, const dvec3& b, const dvec3& c, const dvec3& d) {
    triangle(a, b, c);
    triangle(a, c, d);
  }
  void remove(size_t triangle) {
    const auto first = indices.begin() + static_cast<std::ptrdiff_t>(3 * triangle);
    indices.erase(first, first + 3);
  }
  void flip(size_t triangle) { std::swap(indices[3 * triangle + 1], indices[3 * triangle + 2]); }
  void append(const Shape& other) {
    for (size_t t = 0; t < other.count(); ++t)
      triangle(other.corner(t, 0), other.corner(t, 1), other.corner(t, 2));
  }
};

/// The faces of a box, by bits: x low, x high, y low, y high, bottom, top.
enum Face : unsigned { west = 1, east = 2, south = 4, north = 8, bottom = 16, top = 32, all_faces = 63 };

inline Shape box(const dvec3& low, const dvec3& high, unsigned faces = all_faces) {
  const auto at = [&](int x, int y, int z) {
    return dvec3(x ? high.x : low.x, y ? high.y : low.y, z ? high.z : low.z);
  };
  Shape shape;
  if (faces & west) shape.quad(at(0, 1, 0), at(0, 0, 0), at(0, 0, 1), at(0, 1, 1));
  if (faces & east) shape.quad(at(1, 0, 0), at(1, 1, 0), at(1, 1, 1), at(1, 0, 1));
  if (faces & south) shape.quad(at(0, 0, 0), at(1, 0, 0), at(1, 0, 1), at(0, 0, 1));
  if (faces & north) shape.quad(at(1, 1, 0), at(0, 1, 0), at(0, 1, 1), at(1, 1, 1));
  if (faces & bottom) shape.quad(at(0, 1, 0), at(1, 1, 0), at(1, 0, 0), at(0, 0, 0));
  if (faces & top) shape.quad(at(0, 0, 1), at(1, 0, 1), at(1, 1, 1), at(0, 1, 1));
  return shape;
}

/// A square of n x n cells about the origin whose height is `height(x, y)`.
template <typename Height>
Shape terrain(double size, int n, const Height& height) {
  const auto at = [&](int i, int j) {
    const double x = size * (static_cast<double>(i) / n - 0.5), y = size * (static_cast<double>(j) / n - 0.5);
    return dvec3(x, y, height(x, y));
  };
  Shape shape;
  for (int j = 0; j < n; ++j)
    for (int i = 0; i < n; ++i) shape.quad(at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j + 1));
  return shape;
}

/// An icosahedron whose triangles are cut into four `levels` times, on a sphere. Corners are shared.
inline Shape sphere(double radius, int levels, const dvec3& center = dvec3(0.0)) {
  const double phi = 0.5 * (1.0 + std::sqrt(5.0));
  Shape shape;
  shape.corners = {{-1, phi, 0},  {1, phi, 0},  {-1, -phi, 0}, {1, -phi, 0}, {0, -1, phi},  {0, 1, phi},
                   {0, -1, -phi}, {0, 1, -phi}, {phi, 0, -1},  {phi, 0, 1},  {-phi, 0, -1}, {-phi, 0, 1}};
  shape.indices = {0, 11, 5,  0, 5,  1, 0, 1, 7, 0, 7,  10, 0, 10, 11, 1, 5, 9, 5, 11,
                   4, 11, 10, 2, 10, 7, 6, 7, 1, 8, 3,  9,  4, 3,  4,  2, 3, 2, 6, 3,
                   6, 8,  3,  8, 9,  4, 9, 5, 2, 4, 11, 6,  2, 10, 8,  6, 7, 9, 8, 1};
  for (int level = 0; level < levels; ++level) {
    std::map<std::pair<uint32_t, uint32_t>, uint32_t> middles;
    const auto middle = [&](uint32_t a, uint32_t b) {
      const auto [at, is_new] =
          middles.try_emplace({std::min(a, b), std::max(a, b)}, static_cast<uint32_t>(shape.corners.size()));
      if (is_new) shape.corners.push_back(0.5 * (shape.corners[a] + shape.corners[b]));
      return at->second;
    };
    std::vector<uint32_t> finer;
    for (size_t t = 0; t < shape.count(); ++t) {
      const uint32_t a = shape.indices[3 * t], b = shape.indices[3 * t + 1], c = shape.indices[3 * t + 2];
      const uint32_t ab = middle(a, b), bc = middle(b, c), ca = middle(c, a);
      finer.insert(finer.end(), {a, ab, ca, ab, b, bc, ca, bc, c, ab, bc, ca});
    }
    shape.indices = std::move(finer);
  }
  for (dvec3& corner : shape.corners) corner = center + radius * glm::normalize(corner);
  return shape;
}

/// A glTF file of shapes.
class SceneWriter : public GltfWriter {
 public:
  /// Adds a shape as an object, with its corners rounded to fp32 in the file. `node` may hold transforms.
  int add(const std::string& name, const Shape& shape, json node = json::object(), int material_index = 0) {
    if (!document.contains("materials")) itu_material();
    std::vector<vec3> positions;
    for (const dvec3& p : shape.corners) positions.push_back(vec3(dvec3(p.x, p.z, -p.y)));  // y up
    const json primitive = {{"attributes", {{"POSITION", vec3s(positions)}}},
                            {"indices", indices32(shape.indices)},
                            {"material", material_index}};
    node["name"] = name;
    node["mesh"] = mesh(name, json::array({primitive}));
    return root(std::move(node));
  }
  SceneFaults check(const CheckOptions& options = {}, LoadOptions load = {}) const {
    load.optical_only = load.keep_faults = true;
    return check_scene(this->load(load), options);
  }
};

/// Returns "hole 1, sliver 3" of all that was found.
inline std::string kinds_of(const SceneFaults& faults) {
  std::string text;
  for (const SceneFault& fault : faults.faults)
    text += (text.empty() ? "" : ", ") + fault.kind + " " + std::to_string(fault.count);
  return text;
}

}  // namespace greatx::scene::test
