// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "core/vec.h"
#include "scene/generator/mesh/mesh_builder.h"

namespace greatx::scene::place {

/// Collects triangles into one list per material, about an anchor of whole metres. Coordinates on the grid
/// (scene/place/plane/grid.h) stay exact within 256 m of the anchor. MeshBuilder rounds to millimetres, which
/// would bend planes.
class PlaceMesh {
 public:
  explicit PlaceMesh(const dvec3& anchor = dvec3(0.0)) : anchor_(anchor) {}
  /// Adds a triangle, counter-clockwise from outside, with its plane's normal. Triangles without an area are
  /// left out.
  void triangle(int material, const std::array<dvec3, 3>& corners, const std::array<dvec2, 3>& uvs);
  /// Does the same with normals of its own.
  void triangle(int material, const std::array<dvec3, 3>& corners, const std::array<dvec3, 3>& normals,
                const std::array<dvec2, 3>& uvs);
  bool empty() const { return primitives_.empty(); }
  const dvec3& anchor() const { return anchor_; }
  std::span<const generator::PrimitiveData> primitives() const { return primitives_; }
  size_t triangle_count() const;

 private:
  generator::PrimitiveData& primitive(int material);
  dvec3 anchor_;
  std::vector<generator::PrimitiveData> primitives_;
};

/// Returns texture coordinates on a plane: metres along its level lines and down its slope, over the size of
/// a tile.
dvec2 uv_on_plane(const dvec2& tile_m, const dvec3& point, const dvec3& normal);

}  // namespace greatx::scene::place
