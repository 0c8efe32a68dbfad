// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "scene/generator/objects/smooth_mesh.h"

#include <cmath>
#include <map>

#include "core/error.h"
#include "core/units.h"

namespace greatx::scene::generator {

namespace {

dvec3 mirrored(const dvec3& p) { return {p.x, -p.y, p.z}; }

dvec3 area_of(const std::array<dvec3, 3>& c) { return 0.5 * glm::cross(c[1] - c[0], c[2] - c[0]); }

}  // namespace

void SmoothMesh::triangle(int material, const dvec3& a, const dvec3& b, const dvec3& c) {
  const std::array<dvec3, 3> corners{snap(a), snap(b), snap(c)};
  if (corners[0] == corners[1] || corners[1] == corners[2] || corners[2] == corners[0]) return;
  triangles_.push_back({material, corners});
}

void SmoothMesh::quad(int material, const dvec3& a, const dvec3& b, const dvec3& c, const dvec3& d) {
  const dvec3 p = snap(a), q = snap(b), r = snap(c), s = snap(d);
  const bool whole = p != q && q != r && r != s && s != p;
  const dvec3 first = glm::cross(q - p, r - p), second = glm::cross(r - p, s - p);
  // The diagonal pr is out of the question if it leaves the outline, or if the fold along it is concave: s
  // lies above the plane of pqr.
  const dvec3 facing = first + second;
  const bool outside = glm::dot(first, facing) < 0.0 || glm::dot(second, facing) < 0.0;
  if (whole && (outside || glm::dot(first, s - p) > 1e-9)) {
    triangle(material, p, q, s);
    triangle(material, q, r, s);
    return;
  }
  triangle(material, p, q, r);
  triangle(material, p, r, s);
}

void SmoothMesh::add_to(MeshBuilder& mesh, double crease, const Mapping& mapping) const {
  const double least = std::cos(crease);
  const auto key = [](const dvec3& p) {
    return std::array{std::llround(p.x * 1e3), std::llround(p.y * 1e3), std::llround(p.z * 1e3)};
  };
  std::map<std::array<long long, 3>, std::vector<dvec3>> around;
  for (const Triangle& t : triangles_)
    for (const dvec3& corner : t.corners) around[key(corner)].push_back(area_of(t.corners));
  for (const Triangle& t : triangles_) {
    const dvec3 own = glm::normalize(area_of(t.corners));
    const dvec3 middle = (t.corners[0] + t.corners[1] + t.corners[2]) / 3.0;
    std::array<dvec3, 3> normals;
    std::array<dvec2, 3> uvs{dvec2(0.0), dvec2(0.0), dvec2(0.0)};
    for (size_t i = 0; i < 3; ++i) {
      dvec3 sum(0.0);
      for (const dvec3& other : around[key(t.corners[i])])
        if (glm::dot(own, glm::normalize(other)) >= least) sum += other;
      normals[i] = glm::normalize(sum);
      if (mapping) uvs[i] = mapping(t.corners[i], own, middle);
    }
    mesh.triangle(t.material, t.corners, normals, uvs);
  }
}

void add_half_grid(SmoothMesh& mesh, const HalfGrid& grid) {
  const size_t columns = grid.rows.front().size(), rows = grid.rows.size();
  for (size_t k = 0; k + 1 < rows; ++k) {
    const std::vector<dvec3>&low = grid.rows[k], &high = grid.rows[k + 1];
    GREATX_CHECK(low.size() == columns && high.size() == columns, "row {} has {} points", k, high.size());
    mesh.quad(grid.cell(k, 0), mirrored(low[0]), low[0], high[0], mirrored(high[0]));
    for (size_t c = 0; c + 1 < columns; ++c) {
      const int material = grid.cell(k, c + 1);
      mesh.quad(material, low[c], low[c + 1], high[c + 1], high[c]);
      mesh.quad(material, mirrored(low[c + 1]), mirrored(low[c]), mirrored(high[c]), mirrored(high[c + 1]));
    }
    const size_t last = columns - 1;
    mesh.quad(grid.cell(k, columns), low[last], mirrored(low[last]), mirrored(high[last]), high[last]);
  }
  const std::vector<dvec3>&floor = grid.rows.front(), &roof = grid.rows.back();
  for (size_t c = 0; c + 1 < columns; ++c) {
    mesh.quad(grid.bottom, mirrored(floor[c]), mirrored(floor[c + 1]), floor[c + 1], floor[c]);
    mesh.quad(grid.top(c), mirrored(roof[c + 1]), mirrored(roof[c]), roof[c], roof[c + 1]);
  }
}

void add_rings(SmoothMesh& mesh, const std::vector<std::vector<dvec3>>& rings,
               const std::function<int(size_t ring, size_t point)>& cell) {
  const size_t count = rings.front().size();
  for (size_t k = 0; k + 1 < rings.size(); ++k)
    for (size_t i = 0; i < count; ++i) {
      const size_t j = (i + 1) % count;
      mesh.quad(cell(k, i), rings[k][i], rings[k][j], rings[k + 1][j], rings[k + 1][i]);
    }
  const std::vector<dvec3>&first = rings.front(), &last = rings.back();
  for (size_t i = 1; i + 1 < count; ++i) {
    mesh.triangle(cell(0, i), first[0], first[i + 1], first[i]);
    mesh.triangle(cell(rings.size() - 2, i), last[0], last[i], last[i + 1]);
  }
}

std::vector<dvec3> ring(const dvec3& center, const dvec3& u, const dvec3& v, int count) {
  std::vector<dvec3> points;
  for (int i = 0; i < count; ++i) {
    const double angle = 2.0 * pi * i / count;
    points.push_back(center + std::cos(angle) * u + std::sin(angle) * v);
  }
  return points;
}

void add_tube(SmoothMesh& mesh, int material, std::span<const dvec3> line, double radius, int count) {
  const dvec3 course = glm::normalize(line.back() - line.front());
  const dvec3 aside = std::abs(course.y) < 0.9 ? dvec3(0.0, 1.0, 0.0) : dvec3(1.0, 0.0, 0.0);
  const dvec3 u = glm::normalize(aside - glm::dot(aside, course) * course), v = glm::cross(course, u);
  std::vector<std::vector<dvec3>> rings;
  for (const dvec3& point : line) rings.push_back(ring(point, radius * u, radius * v, count));
  add_rings(mesh, rings, [&](size_t, size_t) { return material; });
}

}  // namespace greatx::scene::generator
