// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Collects flat-shaded faces into one triangle list per material. Positions are whole millimetres, so that
// faces that meet share exact corners and the bytes do not depend on the last bit of a sine.
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <span>
#include <tuple>
#include <unordered_map>
#include <vector>

#include "core/vec.h"

namespace greatx::scene::generator {

/// To whole millimetres.
double snap(double metres);
dvec2 snap(const dvec2& point);
dvec3 snap(const dvec3& point);

struct VertexKey {
  std::array<int32_t, 8> words;  ///< position in mm, normal in 1e-6, uv in 1e-4
  bool operator==(const VertexKey&) const = default;
};
struct VertexKeyHash {
  size_t operator()(const VertexKey& key) const;
};

/// Triangles of one material, z up, indexed; equal vertices are shared.
struct PrimitiveData {
  int material = 0;  ///< index into material_library()
  std::vector<vec3> positions, normals;
  std::vector<vec2> uvs;
  std::vector<uint32_t> indices;
  std::unordered_map<VertexKey, uint32_t, VertexKeyHash> lookup;  ///< only ever looked up, never iterated
};

class MeshBuilder {
 public:
  /// Corners counter-clockwise seen from outside. A triangle that millimetres make degenerate is a
  /// ContractError.
  void triangle(int material, const std::array<dvec3, 3>& corners, const std::array<dvec2, 3>& uvs);
  /// The same with normals of its own (smooth shading).
  void triangle(int material, const std::array<dvec3, 3>& corners, const std::array<dvec3, 3>& normals,
                const std::array<dvec2, 3>& uvs);
  /// A planar quadrilateral with its own texture coordinates.
  void quad(int material, const std::array<dvec3, 4>& corners, const std::array<dvec2, 4>& uvs);
  /// The same, texture in metres (see planar_uv).
  void quad(int material, const dvec3& a, const dvec3& b, const dvec3& c, const dvec3& d);
  /// A planar, simple polygon, possibly concave; texture in metres.
  void polygon(int material, std::span<const dvec3> corners);
  /// A horizontal polygon at height z (corners counter-clockwise from above), facing up or down.
  void flat_polygon(int material, std::span<const dvec2> corners, double z, bool up);
  /// An upright closed prism over a polygon that is counter-clockwise from above.
  void prism(int side, int top, std::span<const dvec2> corners, double bottom_z, double top_z);
  /// A closed prism between y0 and y1 over a profile in the x-z plane, counter-clockwise seen from -y.
  void prism_along_y(int material, std::span<const dvec2> profile, double y0, double y1);
  /// A closed box.
  void box(int material, const dvec3& low, const dvec3& high);
  /// Adds everything of `other`, moved by yaw about z, then `offset`.
  void append(const MeshBuilder& other, const dvec3& offset, double yaw = 0.0);

  const std::vector<PrimitiveData>& primitives() const { return primitives_; }
  bool empty() const { return primitives_.empty(); }
  size_t triangle_count() const;

 private:
  uint32_t vertex(PrimitiveData& primitive, const dvec3& position, const dvec3& normal, const dvec2& uv);
  PrimitiveData& primitive(int material);

  std::vector<PrimitiveData> primitives_;
};

/// Texture coordinates of a point on a face with this normal: metres along the face over the material's tile;
/// glTF's v grows downwards, so it falls with height.
dvec2 planar_uv(int material, const dvec3& point, const dvec3& normal);

/// A regular polygon with `count` corners, the first at angle `phase` (rad).
std::vector<dvec2> regular_polygon(int count, double radius, const dvec2& center = dvec2(0.0),
                                   double phase = 0.0);

/// A polygon moved inwards, edge i (from corner i to i + 1) by `distances[i]`; corners are mitred.
std::vector<dvec2> inset(std::span<const dvec2> corners, std::span<const double> distances);
std::vector<dvec2> inset(std::span<const dvec2> corners, double distance);

/// Triangles of a simple polygon that is counter-clockwise, by ear clipping in exact integer millimetres.
std::vector<std::array<uint32_t, 3>> triangulate(std::span<const dvec2> corners);

/// A closed solid made of rings: each is the footprint moved inwards by `inset_m` at height `z`, joined to
/// the next by walls (same inset) or a strip, level or (over rectangles only) sloping.
struct Ring {
  double inset_m = 0.0;
  double z = 0.0;
  int material = 0;         ///< of the strip up to the next ring; of the cap for the last
  bool whole_bays = false;  ///< fit a whole number of texture bays to each wall
  double base_z = 0.0;      ///< with whole_bays: the height at which the texture starts
  uint32_t shift = 0;       ///< with whole_bays: seeds the bay with which each wall starts; 0: the first
};
struct RingSolid {
  std::vector<dvec2> footprint;  ///< counter-clockwise from above
  std::vector<Ring> rings;       ///< from the bottom up
  int bottom = 0;                ///< material of the bottom cap
  /// Another material for wall `edge` of strip `ring`, or the one given.
  std::function<int(size_t ring, size_t edge, int material)> override_wall;
};
void add_ring_solid(MeshBuilder& mesh, const RingSolid& solid);

}  // namespace greatx::scene::generator
