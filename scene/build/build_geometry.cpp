// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "scene/build/build_geometry.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>
#include <unordered_map>

#include "core/error.h"

namespace greatx::scene {
namespace {

void place_positions(const ModelPrimitive& source, const dmat4& body_from_mesh, VertexData& vertices,
                     const std::string& what) {
  constexpr double limit = std::numeric_limits<float>::max();
  vertices.positions.reserve(source.positions.size());
  for (size_t index = 0; index < source.positions.size(); ++index) {
    const dvec3 position(body_from_mesh * dvec4(dvec3(source.positions[index]), 1.0));
    const bool good =
        std::abs(position.x) < limit && std::abs(position.y) < limit && std::abs(position.z) < limit;
    if (!good) {
      throw_user_error("{}: vertex {} is at ({}, {}, {}) after its transforms: expected finite numbers", what,
                       index, position.x, position.y, position.z);
    }
    vertices.positions.push_back(position);
  }
}

/// Transforms the normals by the inverse transpose, since they describe planes and not directions. The
/// cofactor matrix is the inverse transpose times the determinant, of which only the sign remains after
/// normalization.
void place_normals(const ModelPrimitive& source, const glm::dmat3& linear, VertexData& vertices) {
  const glm::dmat3 cofactors(glm::cross(linear[1], linear[2]), glm::cross(linear[2], linear[0]),
                             glm::cross(linear[0], linear[1]));
  const double sign = glm::determinant(linear) < 0.0 ? -1.0 : 1.0;
  vertices.normals.reserve(source.normals.size());
  for (const vec3& normal : source.normals) {
    vertices.normals.emplace_back(glm::normalize(sign * (cofactors * dvec3(normal))));
  }
}

void place_tangents(const ModelPrimitive& source, const glm::dmat3& linear, VertexData& vertices) {
  const float handedness = glm::determinant(linear) < 0.0 ? -1.0f : 1.0f;
  for (size_t index = 0; index < source.tangents.size(); ++index) {
    const dvec3 tangent = linear * dvec3(source.tangents[index]);
    const double length = glm::length(tangent);
    const float w = source.tangents[index].w < 0.0f ? -handedness : handedness;
    vertices.tangents.emplace_back(vec3(length > 0.0 ? tangent / length : dvec3(0.0)), w);
  }
}

dvec3 triangle_normal(const VertexData& vertices, size_t first, const std::string& what) {
  const dvec3& a = vertices.positions[vertices.indices[first]];
  const dvec3& b = vertices.positions[vertices.indices[first + 1]];
  const dvec3& c = vertices.positions[vertices.indices[first + 2]];
  const dvec3 normal = glm::cross(b - a, c - a);
  const double length = glm::length(normal);
  if (!(length > 0.0) || !std::isfinite(length)) {
    throw_user_error("{}: triangle {} has no area left after its transforms", what, first / 3);
  }
  return normal / length;
}

/// Gives every triangle three vertices of its own, with the triangle's normal.
void make_flat(VertexData& vertices, const std::string& what) {
  VertexData flat;
  const size_t count = vertices.indices.size();
  flat.positions.reserve(count);
  flat.normals.reserve(count);
  flat.uvs.reserve(count);
  flat.source.reserve(count);
  flat.indices.reserve(count);
  for (size_t first = 0; first < count; first += 3) {
    const vec3 normal(triangle_normal(vertices, first, what));
    for (size_t corner = first; corner < first + 3; ++corner) {
      const uint32_t vertex = vertices.indices[corner];
      flat.positions.push_back(vertices.positions[vertex]);
      flat.normals.push_back(normal);
      flat.uvs.push_back(vertices.uvs[vertex]);
      flat.source.push_back(vertex);
      flat.indices.push_back(static_cast<uint32_t>(corner));
    }
  }
  vertices = std::move(flat);
}

struct PlaceKey {
  uint32_t x, y, z;
  bool operator==(const PlaceKey&) const = default;
};
struct PlaceKeyHash {
  size_t operator()(const PlaceKey& key) const {
    uint64_t hash = key.x * 0x9E3779B97F4A7C15ull;
    hash = (hash ^ (hash >> 29) ^ key.y) * 0xBF58476D1CE4E5B9ull;
    hash = (hash ^ (hash >> 32) ^ key.z) * 0x94D049BB133111EBull;
    return hash ^ (hash >> 31);
  }
};

PlaceKey key_of(const vec3& position) {
  const vec3 positive_zero = position + vec3(0.0f);  // -0 and 0 are the same place
  return {std::bit_cast<uint32_t>(positive_zero.x), std::bit_cast<uint32_t>(positive_zero.y),
          std::bit_cast<uint32_t>(positive_zero.z)};
}

}  // namespace

VertexData place_primitive(const ModelPrimitive& source, const dmat4& body_from_mesh, bool want_tangents,
                           const std::string& what) {
  VertexData vertices;
  const glm::dmat3 linear(body_from_mesh);
  const size_t count = source.positions.size();
  place_positions(source, body_from_mesh, vertices, what);
  vertices.uvs = source.uvs.empty() ? std::vector<vec2>(count, vec2(0.0f)) : source.uvs;
  vertices.source.resize(count);
  for (uint32_t vertex = 0; vertex < count; ++vertex) vertices.source[vertex] = vertex;
  vertices.indices = source.indices;
  if (glm::determinant(linear) < 0.0) {
    for (size_t first = 0; first < vertices.indices.size(); first += 3) {
      std::swap(vertices.indices[first + 1], vertices.indices[first + 2]);
    }
  }
  if (source.normals.empty()) {
    make_flat(vertices, what);
  } else {
    for (size_t first = 0; first < vertices.indices.size(); first += 3)
      triangle_normal(vertices, first, what);
    place_normals(source, linear, vertices);
    if (want_tangents) place_tangents(source, linear, vertices);
  }
  if (want_tangents && vertices.tangents.empty()) make_tangents(vertices);
  return vertices;
}

std::vector<std::vector<uint32_t>> weld(const ModelMesh& mesh) {
  std::unordered_map<PlaceKey, uint32_t, PlaceKeyHash> numbers;
  size_t vertices = 0;
  for (const ModelPrimitive& primitive : mesh.primitives) vertices += primitive.positions.size();
  numbers.reserve(vertices);
  std::vector<std::vector<uint32_t>> welded;
  for (const ModelPrimitive& primitive : mesh.primitives) {
    std::vector<uint32_t>& of_primitive = welded.emplace_back();
    of_primitive.reserve(primitive.positions.size());
    for (const vec3& position : primitive.positions) {
      const auto next = static_cast<uint32_t>(numbers.size());
      of_primitive.push_back(numbers.try_emplace(key_of(position), next).first->second);
    }
  }
  return welded;
}

double rounding_noise(const ModelPrimitive& source, const dmat4& body_from_mesh) {
  float largest = 0.0f;
  for (const vec3& position : source.positions) {
    largest = std::max({largest, std::abs(position.x), std::abs(position.y), std::abs(position.z)});
  }
  double scale = 0.0;
  for (int axis = 0; axis < 3; ++axis) scale = std::max(scale, glm::length(dvec3(body_from_mesh[axis])));
  return scale * static_cast<double>(largest) * std::numeric_limits<float>::epsilon();
}

}  // namespace greatx::scene
