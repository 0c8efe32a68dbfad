// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

#include "core/vec.h"

namespace greatx::scene {

/// Holds the vertices of one primitive, ready for upload.
struct VertexData {
  std::vector<dvec3> positions;
  std::vector<vec3> normals;
  std::vector<vec4> tangents;  ///< empty: none wanted
  std::vector<vec2> uvs;
  std::vector<uint32_t> source;  ///< index of the model's vertex from which each vertex comes
  std::vector<uint32_t> indices;
};

/// Computes tangents from positions, normals and uvs. The tangent of a vertex is the sum of d position / d u
/// of its triangles, weighted by their angles at the vertex and made perpendicular to the normal. w is -1
/// where the map is mirrored. A vertex between mirrored and plain triangles is duplicated (as in MikkTSpace).
/// Triangles without area in uv contribute no tangent. A vertex that has only such triangles gets an
/// arbitrary perpendicular of its normal.
void make_tangents(VertexData& vertices);

}  // namespace greatx::scene
