// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "tests/scene/generator/soup.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <map>
#include <numeric>

#include <fmt/format.h>
#include <gtest/gtest.h>

namespace greatx::scene {

dvec3 SoupTriangle::normal() const {
  return glm::normalize(glm::cross(corners[1] - corners[0], corners[2] - corners[0]));
}

std::vector<SoupTriangle> Soup::of_class(SemanticClass semantic_class) const {
  std::vector<SoupTriangle> found;
  for (const SoupTriangle& t : triangles)
    if (model.instances[t.instance].semantic_class == semantic_class) found.push_back(t);
  return found;
}

std::vector<SoupTriangle> Soup::of_instance(uint32_t instance) const {
  std::vector<SoupTriangle> found;
  for (const SoupTriangle& t : triangles)
    if (t.instance == instance) found.push_back(t);
  return found;
}

uint32_t Soup::instance(const std::string& name) const {
  for (uint32_t i = 0; i < model.instances.size(); ++i)
    if (model.instances[i].name == name) return i;
  ADD_FAILURE() << "no instance called " << name;
  return 0;
}

Soup load_soup(const GenerateOptions& options) {
  const std::vector<std::byte> glb = generate_glb(options);
  Soup soup{load_model(options.kind + ".glb", glb, {}), {}};
  for (uint32_t i = 0; i < soup.model.instances.size(); ++i) {
    const ModelInstance& instance = soup.model.instances[i];
    const dmat3 normal_matrix = glm::transpose(glm::inverse(dmat3(instance.model_from_mesh)));
    for (const ModelPrimitive& primitive : soup.model.meshes[instance.mesh].primitives)
      for (size_t k = 0; k < primitive.indices.size(); k += 3) {
        SoupTriangle triangle;
        triangle.material = primitive.material;
        triangle.instance = i;
        for (size_t c = 0; c < 3; ++c) {
          const uint32_t index = primitive.indices[k + c];
          triangle.local[c] = dvec3(primitive.positions[index]);
          triangle.corners[c] = dvec3(instance.model_from_mesh * dvec4(triangle.local[c], 1.0));
          triangle.normals[c] = glm::normalize(normal_matrix * dvec3(primitive.normals[index]));
        }
        soup.triangles.push_back(triangle);
      }
  }
  return soup;
}

namespace {

using Corner = std::array<int64_t, 3>;

Corner millimetres(const dvec3& p) {
  return {std::llround(p.x * 1e3), std::llround(p.y * 1e3), std::llround(p.z * 1e3)};
}

}  // namespace

size_t open_edges(const std::vector<SoupTriangle>& triangles, bool world) {
  std::map<std::pair<Corner, Corner>, int> balance;
  for (const SoupTriangle& t : triangles)
    for (size_t k = 0; k < 3; ++k) {
      const auto& corners = world ? t.corners : t.local;
      const Corner a = millimetres(corners[k]), b = millimetres(corners[(k + 1) % 3]);
      balance[a < b ? std::pair(a, b) : std::pair(b, a)] += a < b ? 1 : -1;
    }
  return static_cast<size_t>(
      std::count_if(balance.begin(), balance.end(), [](const auto& e) { return e.second != 0; }));
}

std::vector<double> part_volumes(const std::vector<SoupTriangle>& triangles) {
  std::vector<size_t> parent(triangles.size());
  std::iota(parent.begin(), parent.end(), size_t{0});
  const std::function<size_t(size_t)> root = [&](size_t i) {
    while (parent[i] != i) i = parent[i] = parent[parent[i]];
    return i;
  };
  std::map<std::pair<uint32_t, Corner>, size_t> owner;
  for (size_t i = 0; i < triangles.size(); ++i)
    for (const dvec3& corner : triangles[i].local) {
      const auto [found, inserted] = owner.try_emplace({triangles[i].instance, millimetres(corner)}, i);
      if (!inserted) parent[root(i)] = root(found->second);
    }
  std::map<size_t, double> volumes;
  for (size_t i = 0; i < triangles.size(); ++i) {
    const auto& c = triangles[i].corners;
    volumes[root(i)] += glm::dot(c[0], glm::cross(c[1], c[2])) / 6.0;
  }
  std::vector<double> result;
  for (const auto& [part, volume] : volumes) result.push_back(volume);
  return result;
}

namespace {

/// Returns the part of a convex polygon to the left of a -> b.
std::vector<dvec2> clip(const std::vector<dvec2>& polygon, const dvec2& a, const dvec2& b) {
  const auto side = [&](const dvec2& p) { return (b.x - a.x) * (p.y - a.y) - (b.y - a.y) * (p.x - a.x); };
  std::vector<dvec2> kept;
  for (size_t i = 0; i < polygon.size(); ++i) {
    const dvec2 p = polygon[i], q = polygon[(i + 1) % polygon.size()];
    const double sp = side(p), sq = side(q);
    if (sp >= 0) kept.push_back(p);
    if ((sp > 0 && sq < 0) || (sp < 0 && sq > 0)) kept.push_back(glm::mix(p, q, sp / (sp - sq)));
  }
  return kept;
}

double area(const std::vector<dvec2>& polygon) {
  double sum = 0.0;
  for (size_t i = 0; i < polygon.size(); ++i) {
    const dvec2 p = polygon[i], q = polygon[(i + 1) % polygon.size()];
    sum += 0.5 * (p.x * q.y - p.y * q.x);
  }
  return sum;
}

struct Flat {
  std::vector<dvec2> corners;  ///< counter-clockwise in the plane's axes
  dvec2 low, high;
  const SoupTriangle* triangle;
};

double overlap(const Flat& a, const Flat& b) {
  if (a.low.y >= b.high.y || b.low.y >= a.high.y) return 0.0;
  std::vector<dvec2> common = a.corners;
  for (size_t i = 0; i < 3 && common.size() > 2; ++i)
    common = clip(common, b.corners[i], b.corners[(i + 1) % 3]);
  return common.size() > 2 ? area(common) : 0.0;
}

}  // namespace

double coplanar_overlap(const Soup& soup, std::string* first) {
  // Planes are compared by normal (0.001) and offset (1 mm). Both faces of a sheet count as one plane.
  std::map<std::array<int64_t, 4>, std::vector<Flat>> planes;
  for (const SoupTriangle& t : soup.triangles) {
    dvec3 n = t.normal();
    const dvec3 size = glm::abs(n);
    const int drop = size.x > size.y && size.x > size.z ? 0 : size.y > size.z ? 1 : 2;
    if (n[drop] < 0.0) n = -n;
    Flat flat{{}, dvec2(1e9), dvec2(-1e9), &t};
    for (const dvec3& corner : t.corners) {
      const dvec2 p(corner[(drop + 1) % 3], corner[(drop + 2) % 3]);
      flat.corners.push_back(p);
      flat.low = glm::min(flat.low, p);
      flat.high = glm::max(flat.high, p);
    }
    if (area(flat.corners) < 0.0) std::reverse(flat.corners.begin(), flat.corners.end());
    planes[{std::llround(n.x * 1e3), std::llround(n.y * 1e3), std::llround(n.z * 1e3),
            std::llround(glm::dot(n, t.corners[0]) * 1e3)}]
        .push_back(flat);
  }
  double total = 0.0;
  for (auto& [plane, flats] : planes) {
    std::sort(flats.begin(), flats.end(), [](const Flat& a, const Flat& b) { return a.low.x < b.low.x; });
    for (size_t i = 0; i < flats.size(); ++i)
      for (size_t j = i + 1; j < flats.size() && flats[j].low.x < flats[i].high.x; ++j) {
        // Far from the origin, two planes with a slightly different normal may have the same offset and still
        // be centimetres apart where the triangles are.
        const SoupTriangle &one = *flats[i].triangle, &other = *flats[j].triangle;
        if (std::ranges::any_of(other.corners, [&](const dvec3& corner) {
              return std::abs(glm::dot(one.normal(), corner - one.corners[0])) > 3e-3;
            }))
          continue;
        const double shared = overlap(flats[i], flats[j]);
        if (shared < 1e-4) continue;  // the edge of a triangle is off by a fraction of a millimetre
        if (total == 0.0 && first != nullptr) {
          const SoupTriangle &a = *flats[i].triangle, &b = *flats[j].triangle;
          *first = fmt::format("{} ({}) and {} ({}) share {:.4f} m^2 near ({:.2f}, {:.2f}, {:.2f})",
                               soup.model.instances[a.instance].name, soup.model.materials[a.material].name,
                               soup.model.instances[b.instance].name, soup.model.materials[b.material].name,
                               shared, a.corners[0].x, a.corners[0].y, a.corners[0].z);
        }
        total += shared;
      }
  }
  return total;
}

}  // namespace greatx::scene
