// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Builds curved, closed bodies and gives them smooth normals: bodies of rows and columns, limbs of rings, and
// tubes.
#pragma once

#include <array>
#include <functional>
#include <span>
#include <vector>

#include "scene/generator/mesh/mesh_builder.h"

namespace greatx::scene::generator {

/// Collects the triangles of curved bodies. Corners are whole millimetres. A triangle two of whose corners
/// coincide is left out, so that several columns of a grid may run into one point.
class SmoothMesh {
 public:
  /// Returns the texture coordinates of a corner of a face with this normal and middle; empty: (0, 0).
  using Mapping = std::function<dvec2(const dvec3& corner, const dvec3& normal, const dvec3& middle)>;

  /// The corners are counter-clockwise as seen from outside.
  void triangle(int material, const dvec3& a, const dvec3& b, const dvec3& c);
  /// Adds a quadrilateral, divided along the diagonal that makes the body convex there.
  void quad(int material, const dvec3& a, const dvec3& b, const dvec3& c, const dvec3& d);
  /// Adds everything to `mesh`. A corner's normal is the mean, by area, over the triangles around that point
  /// whose planes are within `crease` (rad) of its own.
  void add_to(MeshBuilder& mesh, double crease, const Mapping& mapping = {}) const;
  size_t size() const { return triangles_.size(); }

 private:
  struct Triangle {
    int material;
    std::array<dvec3, 3> corners;
  };
  std::vector<Triangle> triangles_;
};

/// A closed body that is its own mirror image in y. Every row goes along the left side (y > 0) from the front
/// to the rear, and the rows follow each other from the bottom to the top. All rows have the same number of
/// points. Points of neighbouring rows or columns may coincide.
struct HalfGrid {
  std::vector<std::vector<dvec3>> rows;
  /// Returns the material of a cell between `row` and the next one. Cell 0 is the front between both sides,
  /// cell i lies between columns i - 1 and i, the last cell is the rear.
  std::function<int(size_t row, size_t cell)> cell;
  int bottom = 0;
  /// Returns the material of the top between columns i and i + 1, from side to side.
  std::function<int(size_t column)> top;
};
void add_half_grid(SmoothMesh& mesh, const HalfGrid& grid);

/// Adds a closed body over rings of equal numbers of points, each counter-clockwise as seen from the end of
/// the body, from its start on. `cell` returns the material between ring and ring + 1, point and point + 1.
void add_rings(SmoothMesh& mesh, const std::vector<std::vector<dvec3>>& rings,
               const std::function<int(size_t ring, size_t point)>& cell);

/// Returns a ring of `count` points about `center` in the plane of the half axes `u` and `v`.
std::vector<dvec3> ring(const dvec3& center, const dvec3& u, const dvec3& v, int count);

/// Adds a closed tube of `count` sides along a line of points, which must not turn by 90 degrees or more.
void add_tube(SmoothMesh& mesh, int material, std::span<const dvec3> line, double radius, int count);

}  // namespace greatx::scene::generator
