// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "scene/build/tangents.h"

#include <cmath>

namespace greatx::scene {
namespace {

/// Holds d position / d u of a triangle, and whether its map is mirrored. glTF's v points down the picture,
/// and the bitangent w n x t points up the picture. A picture that is not mirrored therefore has a negative
/// area in (u, v).
struct TriangleFrame {
  dvec3 tangent{0.0};
  bool mirrored = false;
};

TriangleFrame frame_of(const VertexData& vertices, const uint32_t* corners) {
  const dvec3 edge1 = vertices.positions[corners[1]] - vertices.positions[corners[0]];
  const dvec3 edge2 = vertices.positions[corners[2]] - vertices.positions[corners[0]];
  const dvec2 uv1 = dvec2(vertices.uvs[corners[1]]) - dvec2(vertices.uvs[corners[0]]);
  const dvec2 uv2 = dvec2(vertices.uvs[corners[2]]) - dvec2(vertices.uvs[corners[0]]);
  const double area = uv1.x * uv2.y - uv1.y * uv2.x;
  if (area == 0.0) return {};
  const dvec3 tangent = (edge1 * uv2.y - edge2 * uv1.y) * (area > 0.0 ? 1.0 : -1.0);
  const double length = glm::length(tangent);
  if (!(length > 0.0)) return {};
  return {tangent / length, area > 0.0};
}

double angle_at(const VertexData& vertices, const uint32_t* corners, int corner) {
  const dvec3 here = vertices.positions[corners[corner]];
  const dvec3 one = vertices.positions[corners[(corner + 1) % 3]] - here;
  const dvec3 two = vertices.positions[corners[(corner + 2) % 3]] - here;
  return std::atan2(glm::length(glm::cross(one, two)), glm::dot(one, two));
}

dvec3 any_perpendicular(const dvec3& normal) {
  const dvec3 axis = std::abs(normal.x) < 0.7 ? dvec3(1, 0, 0) : dvec3(0, 1, 0);
  return glm::normalize(glm::cross(axis, normal));
}

vec4 tangent_at(const vec3& normal, const dvec3& sum, bool mirrored) {
  const dvec3 n(normal);
  dvec3 tangent = sum - n * glm::dot(n, sum);
  const double length = glm::length(tangent);
  tangent = length > 1e-9 ? tangent / length : any_perpendicular(n);
  return vec4(vec3(tangent), mirrored ? -1.0f : 1.0f);
}

uint32_t duplicate_vertex(VertexData& vertices, uint32_t vertex) {
  vertices.positions.push_back(dvec3(vertices.positions[vertex]));
  vertices.normals.push_back(vec3(vertices.normals[vertex]));
  vertices.uvs.push_back(vec2(vertices.uvs[vertex]));
  vertices.source.push_back(uint32_t(vertices.source[vertex]));
  return static_cast<uint32_t>(vertices.positions.size() - 1);
}

}  // namespace

void make_tangents(VertexData& vertices) {
  const size_t count = vertices.positions.size();
  std::vector<dvec3> plain(count, dvec3(0.0)), mirrored(count, dvec3(0.0));
  std::vector<bool> has_plain(count, false), has_mirrored(count, false);
  std::vector<bool> triangle_mirrored(vertices.indices.size() / 3, false);
  for (size_t triangle = 0; triangle < triangle_mirrored.size(); ++triangle) {
    const uint32_t* corners = &vertices.indices[triangle * 3];
    const TriangleFrame frame = frame_of(vertices, corners);
    triangle_mirrored[triangle] = frame.mirrored;
    for (int corner = 0; corner < 3; ++corner) {
      const uint32_t vertex = corners[corner];
      (frame.mirrored ? mirrored : plain)[vertex] += angle_at(vertices, corners, corner) * frame.tangent;
      (frame.mirrored ? has_mirrored : has_plain)[vertex] = true;
    }
  }
  std::vector<uint32_t> mirrored_twin(count);
  for (uint32_t vertex = 0; vertex < count; ++vertex) mirrored_twin[vertex] = vertex;
  vertices.tangents.resize(count);
  for (uint32_t vertex = 0; vertex < count; ++vertex) {
    const bool only_mirrored = has_mirrored[vertex] && !has_plain[vertex];
    vertices.tangents[vertex] =
        tangent_at(vertices.normals[vertex], only_mirrored ? mirrored[vertex] : plain[vertex], only_mirrored);
    if (!has_mirrored[vertex] || !has_plain[vertex]) continue;
    mirrored_twin[vertex] = duplicate_vertex(vertices, vertex);
    vertices.tangents.push_back(tangent_at(vertices.normals[vertex], mirrored[vertex], true));
  }
  for (size_t index = 0; index < vertices.indices.size(); ++index) {
    if (triangle_mirrored[index / 3]) vertices.indices[index] = mirrored_twin[vertices.indices[index]];
  }
}

}  // namespace greatx::scene
