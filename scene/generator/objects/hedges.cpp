// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>

#include "core/units.h"
#include "scene/generator/mesh/materials.h"
#include "scene/generator/objects/trees.h"
#include "scene/generator/paint/texture_painter.h"

namespace greatx::scene::generator {

namespace {

/// Returns the chain with points between, at most `step` apart.
std::vector<dvec3> divided(const std::vector<dvec3>& chain, double step) {
  std::vector<dvec3> points{chain.front()};
  for (size_t i = 0; i + 1 < chain.size(); ++i) {
    const int parts = std::max(1, static_cast<int>(std::ceil(glm::distance(chain[i], chain[i + 1]) / step)));
    for (int k = 1; k <= parts; ++k) points.push_back(glm::mix(chain[i], chain[i + 1], k / double(parts)));
  }
  return points;
}

}  // namespace

void add_spray(MeshBuilder& mesh, int material, const dvec3& normal, const dvec3& at, const dvec3& across,
               const dvec3& up, uint32_t draw) {
  const auto [p, uv] = spray_corners(at, across, up, draw);
  for (const auto& [a, b, c] : {std::array<size_t, 3>{0, 1, 2}, std::array<size_t, 3>{0, 2, 3}}) {
    const dvec3 flat = glm::normalize(glm::cross(p[b] - p[a], p[c] - p[a]));
    dvec3 n = glm::normalize(normal + 0.2 * flat);
    while (glm::dot(n, flat) < 0.08) n = glm::normalize(n + 0.2 * flat);
    mesh.triangle(material, {p[a], p[b], p[c]}, {n, n, n}, {uv[a], uv[b], uv[c]});
  }
}

MeshBuilder make_hedge(const std::vector<dvec3>& chain, uint32_t seed) {
  MeshBuilder mesh;
  const int leaves = material("hedge"), sprays = material("sprays_hedge");
  const std::vector<dvec3> points = divided(chain, 2.4);
  const size_t last = points.size() - 1;
  const auto right_at = [&](size_t i) {
    const dvec2 along = glm::normalize(dvec2(points[std::min(i + 1, last)] - points[i == 0 ? 0 : i - 1]));
    return dvec3(along.y, -along.x, 0.0);
  };
  const auto section = [&](size_t i) {
    const dvec3 r = right_at(i), up(0, 0, 1);
    const int key = static_cast<int>(i);
    const double high = 1.55 + 0.3 * uneven(key, 1, seed), wide = 1.0 + 0.16 * uneven(key, 2, seed);
    const dvec3 middle = points[i] + 0.12 * uneven(key, 3, seed) * r;
    return std::array<dvec3, 4>{
        snap(middle + 0.65 * wide * r - 0.5 * up), snap(middle + 0.45 * wide * r + high * up),
        snap(middle - 0.45 * wide * r + high * up), snap(middle - 0.65 * wide * r - 0.5 * up)};
  };
  const auto quad = [&](const dvec3& a, const dvec3& b, const dvec3& c, const dvec3& d) {
    mesh.polygon(leaves, std::array{a, b, c});
    mesh.polygon(leaves, std::array{a, c, d});
  };
  for (size_t i = 0; i < last; ++i) {
    const auto a = section(i), b = section(i + 1);
    for (size_t k = 0; k < 4; ++k) quad(a[k], b[k], b[(k + 1) % 4], a[(k + 1) % 4]);
    const dvec3 along = glm::normalize(b[1] - a[1]), r = right_at(i);
    for (int n = 0; n < 3; ++n) {
      // One spray on the top, and one on each side near the top.
      const int key = 8 * static_cast<int>(i) + n;
      const dvec3 out = n == 0 ? dvec3(0, 0, 1) : (n == 1 ? 1.0 : -1.0) * r;
      const double at = 0.5 + 0.35 * uneven(key, 4, seed), half = 0.62 + 0.14 * uneven(key, 5, seed);
      const dvec3 rim = n == 1 ? glm::mix(a[1], b[1], at) : glm::mix(a[2], b[2], at);
      const dvec3 middle = n == 0 ? 0.5 * (glm::mix(a[1], b[1], at) + glm::mix(a[2], b[2], at)) : rim;
      dvec3 normal = glm::normalize(out + 0.5 * dvec3(0, 0, 1) +
                                    0.35 * dvec3(uneven(key, 6, seed), uneven(key, 7, seed), 0));
      if (n == 0)  // upright, so that the outline is uneven
        normal = glm::normalize(r * (i % 2 == 0 ? 1.0 : -1.0) + 0.35 * along * uneven(key, 8, seed));
      const dvec3 across = glm::normalize(glm::cross(dvec3(0, 0, 1), normal));
      const dvec3 up = glm::cross(normal, across);
      add_spray(mesh, sprays, glm::normalize(out + dvec3(0, 0, 0.6)),
                middle + dvec3(0, 0, n == 0 ? 0.1 : -0.3), half * across, half * up, hash(key, 9, seed));
    }
  }
  const auto first = section(0), end = section(last);
  quad(first[0], first[1], first[2], first[3]);
  quad(end[3], end[2], end[1], end[0]);
  return mesh;
}

MeshBuilder make_grass(const std::vector<dvec3>& feet, uint32_t seed) {
  MeshBuilder mesh;
  const int grass = material("grass_tuft");
  int key = 0;
  for (const dvec3& foot : feet) {
    ++key;
    const double angle = pi * uneven(key, 1, seed), half = 0.42 + 0.14 * uneven(key, 2, seed);
    const double high = 0.24 + 0.1 * uneven(key, 3, seed);
    const dvec3 across(std::cos(angle), std::sin(angle), 0.0);
    // Grass is as bright as the ground around it, so its normal is the ground's. A face that is seen from
    // behind turns its normal over, so that each tuft has two faces, a centimetre apart.
    const dvec3 out(-std::sin(angle), std::cos(angle), 0.0), middle = foot + dvec3(0, 0, high - 0.05);
    for (const double side : {1.0, -1.0})
      add_spray(mesh, grass, {0, 0, 1}, middle - 0.006 * side * out, side * half * across, dvec3(0, 0, high),
                hash(key, 4, seed));
  }
  return mesh;
}

}  // namespace greatx::scene::generator
