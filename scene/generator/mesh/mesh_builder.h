// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Collects faces into one triangle list per material. Positions are whole millimetres, so that faces that
// meet share exact corners, and the bytes do not depend on the last bit of a sine.
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

/// Returns the value rounded to whole millimetres.
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

/// Indexed triangles of one material, z up. Equal vertices are shared.
struct PrimitiveData {
  int material = 0;  ///< index into material_library()
  std::vector<vec3> positions, normals;
  std::vector<vec2> uvs;
  std::vector<uint32_t> indices;
  std::unordered_map<VertexKey, uint32_t, VertexKeyHash> lookup;  ///< for look-ups alone, never iterated
};

class MeshBuilder {
 public:
  /// Adds a triangle with its own plane's normal. The corners are counter-clockwise as seen from outside.
  /// Throws ContractError if the triangle is degenerate after rounding to millimetres.
  void triangle(int material, const std::array<dvec3, 3>& corners, const std::array<dvec2, 3>& uvs);
  /// Adds a triangle with the given normals (smooth shading).
  void triangle(int material, const std::array<dvec3, 3>& corners, const std::array<dvec3, 3>& normals,
                const std::array<dvec2, 3>& uvs);
  /// Adds a planar quadrilateral with the given texture coordinates.
  void quad(int material, const std::array<dvec3, 4>& corners, const std::array<dvec2, 4>& uvs);
  /// Adds a planar quadrilateral with texture coordinates in metres (see planar_uv).
  void quad(int material, const dvec3& a, const dvec3& b, const dvec3& c, const dvec3& d);
  /// Adds a planar, simple polygon, which may be concave, with texture coordinates in metres.
  void polygon(int material, std::span<const dvec3> corners);
  /// Adds a horizontal polygon at height z that faces up or down. The corners are counter-clockwise as seen
  /// from above.
  void flat_polygon(int material, std::span<const dvec2> corners, double z, bool up);
  /// Adds an upright closed prism over a polygon that is counter-clockwise as seen from above.
  void prism(int side, int top, std::span<const dvec2> corners, double bottom_z, double top_z);
  /// Adds a closed prism between y0 and y1 over a profile in the x-z plane that is counter-clockwise as seen
  /// from -y.
  void prism_along_y(int material, std::span<const dvec2> profile, double y0, double y1);
  /// Adds a closed box.
  void box(int material, const dvec3& low, const dvec3& high);
  /// Adds everything of `other`, turned by `yaw` about z and then moved by `offset`.
  void append(const MeshBuilder& other, const dvec3& offset, double yaw = 0.0);

  const std::vector<PrimitiveData>& primitives() const { return primitives_; }
  bool empty() const { return primitives_.empty(); }

 private:
  uint32_t vertex(PrimitiveData& primitive, const dvec3& position, const dvec3& normal, const dvec2& uv);
  PrimitiveData& primitive(int material);

  std::vector<PrimitiveData> primitives_;
};

/// Returns the texture coordinates of a point on a face with this normal: metres along the face, divided by
/// the tile size of the material. glTF's v points downwards, so v falls with height.
dvec2 planar_uv(int material, const dvec3& point, const dvec3& normal);

/// Returns a regular polygon with `count` corners, the first at the angle `phase` (rad).
std::vector<dvec2> regular_polygon(int count, double radius, const dvec2& center = dvec2(0.0),
                                   double phase = 0.0);

/// Returns the polygon with edge i (from corner i to i + 1) moved inwards by `distances[i]`. Corners are
/// mitred.
std::vector<dvec2> inset(std::span<const dvec2> corners, std::span<const double> distances);
std::vector<dvec2> inset(std::span<const dvec2> corners, double distance);

/// Divides a simple, counter-clockwise polygon into triangles by ear clipping, in exact integer millimetres.
std::vector<std::array<uint32_t, 3>> triangulate(std::span<const dvec2> corners);

/// One ring of a RingSolid: the footprint moved inwards by `inset_m`, at height `z`. Walls (same inset) or a
/// strip join the ring to the next one. A strip is level, or slopes (over rectangles only).
struct Ring {
  double inset_m = 0.0;
  double z = 0.0;
  int material = 0;         ///< material of the strip up to the next ring, or of the cap for the last ring
  bool whole_bays = false;  ///< fit a whole number of texture bays to each wall
  double base_z = 0.0;      ///< with whole_bays: height at which the texture starts
  uint32_t shift = 0;       ///< with whole_bays: seed of the bay at which each wall starts; 0: the first bay
};
struct RingSolid {
  std::vector<dvec2> footprint;  ///< counter-clockwise from above
  std::vector<Ring> rings;       ///< from the bottom up
  int bottom = 0;                ///< material of the bottom cap
  /// Returns the material of the wall over `edge` between `ring` and the next one: `material` or another one.
  std::function<int(size_t ring, size_t edge, int material)> override_wall;
};
void add_ring_solid(MeshBuilder& mesh, const RingSolid& solid);

}  // namespace greatx::scene::generator
