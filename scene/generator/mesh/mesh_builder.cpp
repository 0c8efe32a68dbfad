// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "scene/generator/mesh/mesh_builder.h"

#include <algorithm>
#include <cmath>

#include "core/error.h"
#include "core/units.h"
#include "scene/generator/mesh/materials.h"

namespace greatx::scene::generator {

namespace {

int32_t millimetres(double metres) { return static_cast<int32_t>(std::llround(metres * 1e3)); }

}  // namespace

double snap(double metres) { return static_cast<double>(std::llround(metres * 1e3)) / 1e3; }
dvec2 snap(const dvec2& point) { return {snap(point.x), snap(point.y)}; }
dvec3 snap(const dvec3& point) { return {snap(point.x), snap(point.y), snap(point.z)}; }

size_t VertexKeyHash::operator()(const VertexKey& key) const {
  uint64_t hash = 0xcbf29ce484222325u;
  for (const int32_t word : key.words) hash = (hash ^ static_cast<uint32_t>(word)) * 0x100000001b3u;
  return static_cast<size_t>(hash ^ (hash >> 29));
}

dvec2 planar_uv(int material, const dvec3& point, const dvec3& normal) {
  const dvec2 tile = material_library()[static_cast<size_t>(material)].tile_m;
  if (std::abs(normal.z) > 0.9) return {point.x / tile.x, -point.y / tile.y};
  const dvec2 along = glm::normalize(dvec2(-normal.y, normal.x));
  const double slope = std::max(0.2, std::sqrt(1.0 - normal.z * normal.z));
  return {glm::dot(along, dvec2(point)) / tile.x, -point.z / slope / tile.y};
}

PrimitiveData& MeshBuilder::primitive(int material) {
  for (PrimitiveData& existing : primitives_)
    if (existing.material == material) return existing;
  primitives_.emplace_back().material = material;
  return primitives_.back();
}

uint32_t MeshBuilder::vertex(PrimitiveData& target, const dvec3& position, const dvec3& normal,
                             const dvec2& uv) {
  VertexKey key;
  for (int i = 0; i < 3; ++i) {
    key.words[static_cast<size_t>(i)] = millimetres(position[i]);
    key.words[static_cast<size_t>(i + 3)] = static_cast<int32_t>(std::llround(normal[i] * 1e6));
  }
  for (int i = 0; i < 2; ++i)
    key.words[static_cast<size_t>(i + 6)] = static_cast<int32_t>(std::llround(uv[i] * 1e4));
  const auto [found, inserted] = target.lookup.emplace(key, static_cast<uint32_t>(target.positions.size()));
  if (inserted) {
    const auto& w = key.words;
    target.positions.emplace_back(static_cast<float>(w[0] / 1e3), static_cast<float>(w[1] / 1e3),
                                  static_cast<float>(w[2] / 1e3));
    target.normals.emplace_back(static_cast<float>(w[3] / 1e6), static_cast<float>(w[4] / 1e6),
                                static_cast<float>(w[5] / 1e6));
    target.uvs.emplace_back(static_cast<float>(w[6] / 1e4), static_cast<float>(w[7] / 1e4));
  }
  return found->second;
}

void MeshBuilder::triangle(int material, const std::array<dvec3, 3>& corners,
                           const std::array<dvec3, 3>& normals, const std::array<dvec2, 3>& uvs) {
  const dvec3 a = snap(corners[0]), b = snap(corners[1]), c = snap(corners[2]);
  GREATX_CHECK(glm::length(glm::cross(b - a, c - a)) > 1e-7,
               "degenerate triangle at ({}, {}, {}), material {}", a.x, a.y, a.z, material);
  PrimitiveData& target = primitive(material);
  for (size_t i = 0; i < 3; ++i) target.indices.push_back(vertex(target, corners[i], normals[i], uvs[i]));
}

void MeshBuilder::triangle(int material, const std::array<dvec3, 3>& corners,
                           const std::array<dvec2, 3>& uvs) {
  const dvec3 a = snap(corners[0]), b = snap(corners[1]), c = snap(corners[2]);
  const dvec3 normal = glm::normalize(glm::cross(b - a, c - a));
  triangle(material, corners, {normal, normal, normal}, uvs);
}

void MeshBuilder::quad(int material, const std::array<dvec3, 4>& corners, const std::array<dvec2, 4>& uvs) {
  // Both halves get one normal, from the diagonals.
  const dvec3 normal =
      glm::normalize(glm::cross(snap(corners[2]) - snap(corners[0]), snap(corners[3]) - snap(corners[1])));
  triangle(material, {corners[0], corners[1], corners[2]}, {normal, normal, normal},
           {uvs[0], uvs[1], uvs[2]});
  triangle(material, {corners[0], corners[2], corners[3]}, {normal, normal, normal},
           {uvs[0], uvs[2], uvs[3]});
}

void MeshBuilder::quad(int material, const dvec3& a, const dvec3& b, const dvec3& c, const dvec3& d) {
  const dvec3 normal = glm::normalize(glm::cross(snap(c) - snap(a), snap(d) - snap(b)));
  quad(material, {a, b, c, d},
       {planar_uv(material, a, normal), planar_uv(material, b, normal), planar_uv(material, c, normal),
        planar_uv(material, d, normal)});
}

void MeshBuilder::polygon(int material, std::span<const dvec3> corners) {
  dvec3 area(0.0);
  for (size_t i = 0; i < corners.size(); ++i)
    area += glm::cross(snap(corners[i]), snap(corners[(i + 1) % corners.size()]));
  const dvec3 normal = glm::normalize(area);
  // Drop the axis along which the polygon is thinnest, and keep the polygon counter-clockwise.
  const dvec3 size = glm::abs(normal);
  const int drop = size.x > size.y && size.x > size.z ? 0 : size.y > size.z ? 1 : 2;
  std::vector<dvec2> flat;
  for (const dvec3& corner : corners) {
    dvec2 p(corner[(drop + 1) % 3], corner[(drop + 2) % 3]);
    if (normal[drop] < 0.0) p = {p.y, p.x};
    flat.push_back(p);
  }
  for (const auto& t : triangulate(flat)) {
    const std::array<dvec3, 3> points{corners[t[0]], corners[t[1]], corners[t[2]]};
    triangle(material, points, {normal, normal, normal},
             {planar_uv(material, points[0], normal), planar_uv(material, points[1], normal),
              planar_uv(material, points[2], normal)});
  }
}

void MeshBuilder::flat_polygon(int material, std::span<const dvec2> corners, double z, bool up) {
  std::vector<dvec3> points;
  for (const dvec2& corner : corners) points.emplace_back(corner, z);
  if (!up) std::reverse(points.begin(), points.end());
  polygon(material, points);
}

void MeshBuilder::prism(int side, int top, std::span<const dvec2> corners, double bottom_z, double top_z) {
  for (size_t i = 0; i < corners.size(); ++i) {
    const dvec2 a = corners[i], b = corners[(i + 1) % corners.size()];
    quad(side, dvec3(a, bottom_z), dvec3(b, bottom_z), dvec3(b, top_z), dvec3(a, top_z));
  }
  flat_polygon(top, corners, top_z, true);
  flat_polygon(top, corners, bottom_z, false);
}

void MeshBuilder::prism_along_y(int material, std::span<const dvec2> profile, double y0, double y1) {
  std::vector<dvec3> near, far;
  for (const dvec2& p : profile) {
    near.emplace_back(p.x, y0, p.y);
    far.emplace_back(p.x, y1, p.y);
  }
  for (size_t i = 0; i < profile.size(); ++i) {
    const size_t j = (i + 1) % profile.size();
    quad(material, near[i], far[i], far[j], near[j]);
  }
  polygon(material, near);
  std::reverse(far.begin(), far.end());
  polygon(material, far);
}

void MeshBuilder::box(int material, const dvec3& low, const dvec3& high) {
  const std::array<dvec2, 4> corners{dvec2(low), dvec2(high.x, low.y), dvec2(high), dvec2(low.x, high.y)};
  prism(material, material, corners, low.z, high.z);
}

void MeshBuilder::append(const MeshBuilder& other, const dvec3& offset, double yaw) {
  const double c = std::cos(yaw), s = std::sin(yaw);
  const auto turn = [&](const dvec3& p) { return dvec3(c * p.x - s * p.y, s * p.x + c * p.y, p.z); };
  for (const PrimitiveData& source : other.primitives_)
    for (size_t i = 0; i < source.indices.size(); i += 3) {
      std::array<dvec3, 3> points, normals;
      std::array<dvec2, 3> uvs;
      for (size_t k = 0; k < 3; ++k) {
        const uint32_t index = source.indices[i + k];
        points[k] = turn(dvec3(source.positions[index])) + offset;
        normals[k] = turn(dvec3(source.normals[index]));
        uvs[k] = dvec2(source.uvs[index]);
      }
      triangle(source.material, points, normals, uvs);
    }
}

}  // namespace greatx::scene::generator
