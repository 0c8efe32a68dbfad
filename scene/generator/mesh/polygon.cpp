// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include <cmath>
#include <numeric>

#include "core/error.h"
#include "core/units.h"
#include "scene/generator/mesh/materials.h"
#include "scene/generator/mesh/mesh_builder.h"
#include "scene/generator/paint/texture_painter.h"

namespace greatx::scene::generator {

namespace {

struct Point {
  int64_t x, y;
};

/// Returns twice the signed area, exactly.
int64_t twice_area(const Point& a, const Point& b, const Point& c) {
  return (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x);
}

bool inside_or_on(const Point& p, const Point& a, const Point& b, const Point& c) {
  return twice_area(a, b, p) >= 0 && twice_area(b, c, p) >= 0 && twice_area(c, a, p) >= 0;
}

bool is_ear(const std::vector<Point>& points, const std::vector<uint32_t>& left, size_t i) {
  const size_t n = left.size();
  const uint32_t ia = left[(i + n - 1) % n], ib = left[i], ic = left[(i + 1) % n];
  if (twice_area(points[ia], points[ib], points[ic]) <= 0) return false;
  for (const uint32_t other : left)
    if (other != ia && other != ib && other != ic &&
        inside_or_on(points[other], points[ia], points[ib], points[ic]))
      return false;
  return true;
}

}  // namespace

std::vector<std::array<uint32_t, 3>> triangulate(std::span<const dvec2> corners) {
  std::vector<Point> points;
  for (const dvec2& c : corners) points.push_back({std::llround(c.x * 1e3), std::llround(c.y * 1e3)});
  std::vector<uint32_t> left(points.size());
  std::iota(left.begin(), left.end(), 0u);
  std::vector<std::array<uint32_t, 3>> triangles;
  while (left.size() > 3) {
    // Of the ears, cut the one with the shortest new edge. This avoids slivers.
    size_t best = left.size();
    int64_t best_length = 0;
    for (size_t i = 0; i < left.size(); ++i) {
      if (!is_ear(points, left, i)) continue;
      const Point& a = points[left[(i + left.size() - 1) % left.size()]];
      const Point& c = points[left[(i + 1) % left.size()]];
      const int64_t length = (a.x - c.x) * (a.x - c.x) + (a.y - c.y) * (a.y - c.y);
      if (best == left.size() || length < best_length) {
        best = i;
        best_length = length;
      }
    }
    GREATX_CHECK(best < left.size(),
                 "no ear among {} corners: the polygon is not simple or not counter-clockwise", left.size());
    const size_t n = left.size();
    triangles.push_back({left[(best + n - 1) % n], left[best], left[(best + 1) % n]});
    left.erase(left.begin() + static_cast<std::ptrdiff_t>(best));
  }
  GREATX_CHECK(twice_area(points[left[0]], points[left[1]], points[left[2]]) > 0,
               "last ear of {} corners is flat", corners.size());
  triangles.push_back({left[0], left[1], left[2]});
  return triangles;
}

std::vector<dvec2> regular_polygon(int count, double radius, const dvec2& center, double phase) {
  std::vector<dvec2> corners;
  for (int i = 0; i < count; ++i) {
    const double angle = phase + 2.0 * pi * i / count;
    corners.push_back(snap(center + radius * dvec2(std::cos(angle), std::sin(angle))));
  }
  return corners;
}

std::vector<dvec2> inset(std::span<const dvec2> corners, std::span<const double> distances) {
  const size_t n = corners.size();
  std::vector<dvec2> moved;
  for (size_t i = 0; i < n; ++i) {
    const size_t before = (i + n - 1) % n;
    const dvec2 d0 = glm::normalize(corners[i] - corners[before]);
    const dvec2 d1 = glm::normalize(corners[(i + 1) % n] - corners[i]);
    const dvec2 n0(-d0.y, d0.x), n1(-d1.y, d1.x);  // inwards
    // The new corner is corners[i] + n1 distances[i] + d1 t. Choose t such that the corner lies
    // distances[before] from the edge before.
    const double sine = d0.x * d1.y - d0.y * d1.x;
    if (std::abs(sine) < 1e-6) {
      moved.push_back(snap(corners[i] + n1 * distances[i]));
      continue;
    }
    const double along = (distances[before] - distances[i] * glm::dot(n0, n1)) / sine;
    moved.push_back(snap(corners[i] + n1 * distances[i] + d1 * along));
  }
  return moved;
}

std::vector<dvec2> inset(std::span<const dvec2> corners, double distance) {
  return inset(corners, std::vector<double>(corners.size(), distance));
}

namespace {

/// Adds the walls between ring r and the next ring above it.
void add_walls(MeshBuilder& mesh, const RingSolid& solid, size_t r, const std::vector<dvec2>& corners) {
  const Ring& low = solid.rings[r];
  const Ring& high = solid.rings[r + 1];
  for (size_t i = 0; i < corners.size(); ++i) {
    const dvec2 a = corners[i], b = corners[(i + 1) % corners.size()];
    const int material = solid.override_wall ? solid.override_wall(r, i, low.material) : low.material;
    const std::array<dvec3, 4> quad{dvec3(a, low.z), dvec3(b, low.z), dvec3(b, high.z), dvec3(a, high.z)};
    const MaterialSpec& spec = material_library()[static_cast<size_t>(material)];
    if (!low.whole_bays || spec.bays == 0) {
      mesh.quad(material, quad[0], quad[1], quad[2], quad[3]);
      continue;
    }
    const double bay = spec.tile_m.x / spec.bays;
    const double u = std::max(1.0, std::round(glm::length(b - a) / bay)) / spec.bays;
    const double v0 = -(low.z - low.base_z) / spec.tile_m.y, v1 = -(high.z - low.base_z) / spec.tile_m.y;
    // Shift by whole pairs of bays, so that features that alternate from bay to bay stay aligned from floor
    // to floor.
    const uint32_t pairs = static_cast<uint32_t>(std::max(1, spec.bays / 2));
    const double u0 = low.shift == 0
                          ? 0.0
                          : 2.0 * static_cast<double>(hash(static_cast<int>(i), 0, low.shift) % pairs) /
                                std::max(2, spec.bays);
    mesh.quad(material, quad, {dvec2(u0, v0), dvec2(u0 + u, v0), dvec2(u0 + u, v1), dvec2(u0, v1)});
  }
}

}  // namespace

void add_ring_solid(MeshBuilder& mesh, const RingSolid& solid) {
  std::vector<dvec2> corners = inset(solid.footprint, solid.rings.front().inset_m);
  mesh.flat_polygon(solid.bottom, corners, solid.rings.front().z, false);
  for (size_t r = 0; r + 1 < solid.rings.size(); ++r) {
    const Ring& low = solid.rings[r];
    const Ring& high = solid.rings[r + 1];
    if (low.inset_m == high.inset_m) {
      add_walls(mesh, solid, r, corners);
      continue;
    }
    // A sloping strip is planar if opposite edges are parallel to the millimetre, as over rectangles.
    const std::vector<dvec2> inner = inset(solid.footprint, high.inset_m);
    for (size_t i = 0; i < corners.size(); ++i) {
      const size_t j = (i + 1) % corners.size();
      mesh.quad(low.material, dvec3(corners[i], low.z), dvec3(corners[j], low.z), dvec3(inner[j], high.z),
                dvec3(inner[i], high.z));
    }
    corners = inner;
  }
  mesh.flat_polygon(solid.rings.back().material, corners, solid.rings.back().z, true);
}

}  // namespace greatx::scene::generator
