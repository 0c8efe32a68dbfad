// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

#include "core/vec.h"

namespace greatx::scene {

/// Vertices of one primitive, ready for upload.
struct VertexData {
  std::vector<dvec3> positions;
  std::vector<vec3> normals;
  std::vector<vec4> tangents;  ///< empty: none wanted
  std::vector<vec2> uvs;
  std::vector<uint32_t> source;  ///< index of the model's vertex that each one came from
  std::vector<uint32_t> indices;
};

/// Makes tangents from positions, normals and uvs: per vertex the sum of its triangles' d position / d u,
/// weighed by their angle at the vertex, made perpendicular to the normal; w = -1 where the map is mirrored.
/// A vertex between mirrored and plain triangles is doubled (as MikkTSpace does). Triangles without area in
/// uv give no tangent of their own; a vertex that only has such gets any perpendicular of its normal.
void make_tangents(VertexData& vertices);

}  // namespace greatx::scene
