// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "scene/place/assemble/place_mesh.h"

#include <bit>
#include <cmath>

namespace greatx::scene::place {

namespace {

/// Rounds to 1e-6, so that the bytes do not depend on the last bit of a sine.
double micro(double value) { return static_cast<double>(std::llround(value * 1e6)) / 1e6; }

uint32_t vertex(generator::PrimitiveData& target, const vec3& position, const vec3& normal, const vec2& uv) {
  generator::VertexKey key;
  const std::array<float, 8> values{position.x, position.y, position.z, normal.x,
                                    normal.y,   normal.z,   uv.x,       uv.y};
  for (size_t i = 0; i < 8; ++i) key.words[i] = std::bit_cast<int32_t>(values[i] + 0.0f);  // -0 is 0
  const auto [found, is_new] = target.lookup.emplace(key, static_cast<uint32_t>(target.positions.size()));
  if (is_new) {
    target.positions.push_back(position);
    target.normals.push_back(normal);
    target.uvs.push_back(uv);
  }
  return found->second;
}

}  // namespace

generator::PrimitiveData& PlaceMesh::primitive(int material) {
  for (generator::PrimitiveData& existing : primitives_)
    if (existing.material == material) return existing;
  primitives_.emplace_back().material = material;
  return primitives_.back();
}

void PlaceMesh::triangle(int material, const std::array<dvec3, 3>& corners, const std::array<dvec2, 3>& uvs) {
  const dvec3 normal = glm::cross(corners[1] - corners[0], corners[2] - corners[0]);
  const double length = glm::length(normal);
  if (!(length > 1e-9)) return;
  triangle(material, corners, {normal / length, normal / length, normal / length}, uvs);
}

void PlaceMesh::triangle(int material, const std::array<dvec3, 3>& corners,
                         const std::array<dvec3, 3>& normals, const std::array<dvec2, 3>& uvs) {
  generator::PrimitiveData& target = primitive(material);
  for (size_t i = 0; i < 3; ++i) {
    const dvec3 n(micro(normals[i].x), micro(normals[i].y), micro(normals[i].z));
    const dvec2 uv(micro(uvs[i].x), micro(uvs[i].y));
    target.indices.push_back(vertex(target, vec3(corners[i] - anchor_), vec3(n), vec2(uv)));
  }
}

size_t PlaceMesh::triangle_count() const {
  size_t count = 0;
  for (const generator::PrimitiveData& data : primitives_) count += data.indices.size() / 3;
  return count;
}

dvec2 uv_on_plane(const dvec2& tile_m, const dvec3& point, const dvec3& normal) {
  const double flat = std::hypot(normal.x, normal.y);
  if (flat < 0.02) return {point.x / tile_m.x, -point.y / tile_m.y};
  const dvec2 along = dvec2(-normal.y, normal.x) / flat;
  return {glm::dot(along, dvec2(point)) / tile_m.x, -point.z / flat / tile_m.y};
}

}  // namespace greatx::scene::place
