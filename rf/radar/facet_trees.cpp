// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "rf/radar/facet_trees.h"

#include <algorithm>
#include <array>
#include <numeric>

#include "core/error.h"

namespace greatx::rf {
namespace {

scene::Bounds bounds_of(const scene::FacetTriangle& triangle) {
  scene::Bounds bounds;
  for (const dvec3& corner : triangle.corners) bounds.add(corner);
  return bounds;
}

}  // namespace

FacetTrees::FacetTrees(const scene::Scene& scene) : root_(scene.facets.size(), no_tree) {
  for (uint32_t i = 0; i < scene.facets.size(); ++i) {
    const scene::Facet& facet = scene.facets[i];
    if (facet.triangle_count <= small_facet) continue;
    const uint32_t base = static_cast<uint32_t>(order_.size());
    order_.resize(base + facet.triangle_count);
    std::iota(order_.begin() + base, order_.end(), 0u);
    root_[i] = static_cast<uint32_t>(nodes_.size());
    nodes_.push_back({dvec3(0.0), dvec3(0.0), base, facet.triangle_count, 0});
    split(root_[i], scene, facet);
  }
}

void FacetTrees::split(uint32_t node, const scene::Scene& scene, const scene::Facet& facet) {
  const scene::FacetTriangle* triangles = scene.facet_triangles.data() + facet.first_triangle;
  const uint32_t first = nodes_[node].first, count = nodes_[node].count;
  scene::Bounds bounds;
  for (uint32_t i = 0; i < count; ++i) bounds.add(bounds_of(triangles[order_[first + i]]));
  nodes_[node].center = bounds.center();
  nodes_[node].half = 0.5 * bounds.size();
  if (count <= leaf_size) return;
  const dvec3 size = bounds.size();
  const int axis = size.x >= size.y && size.x >= size.z ? 0 : size.y >= size.z ? 1 : 2;
  const auto key = [&](uint32_t i) { return bounds_of(triangles[i]).center()[axis]; };
  std::sort(order_.begin() + first, order_.begin() + first + count,
            [&](uint32_t a, uint32_t b) { return key(a) != key(b) ? key(a) < key(b) : a < b; });
  const uint32_t left = static_cast<uint32_t>(nodes_.size()), half = count / 2;
  nodes_[node].left = left;
  nodes_.push_back({dvec3(0.0), dvec3(0.0), first, half, 0});
  nodes_.push_back({dvec3(0.0), dvec3(0.0), first + half, count - half, 0});
  split(left, scene, facet);
  split(left + 1, scene, facet);
}

void FacetTrees::find(const FacetWorld& world, uint32_t facet, std::span<const KeptSide> spaces,
                      std::vector<uint32_t>& triangles) const {
  triangles.clear();
  const PosedFacet& posed = world.facet(facet);
  if (root_[facet] == no_tree) {
    for (uint32_t i = 0; i < posed.triangle_count; ++i) triangles.push_back(i);
    return;
  }
  std::array<KeptSide, 8> local;
  GREATX_CHECK(spaces.size() <= local.size(), "{} half-spaces", spaces.size());
  for (size_t i = 0; i < spaces.size(); ++i) {
    local[i] = spaces[i];
    if (posed.body == 0) continue;
    const Pose& pose = world.motion(posed.body).pose;
    local[i].offset += glm::dot(spaces[i].normal, pose.position);
    local[i].normal = glm::conjugate(pose.orientation) * spaces[i].normal;
  }
  const auto outside = [&](const Node& node) {
    for (size_t i = 0; i < spaces.size(); ++i)
      if (glm::dot(local[i].normal, node.center) + local[i].offset +
              glm::dot(glm::abs(local[i].normal), node.half) <
          0.0)
        return true;
    return false;
  };
  std::array<uint32_t, 64> stack;
  uint32_t depth = 0;
  stack[depth++] = root_[facet];
  while (depth > 0) {
    const Node& node = nodes_[stack[--depth]];
    if (outside(node)) continue;
    if (node.left == 0) {
      for (uint32_t i = 0; i < node.count; ++i) triangles.push_back(order_[node.first + i]);
      continue;
    }
    stack[depth++] = node.left;
    stack[depth++] = node.left + 1;
  }
  std::sort(triangles.begin(), triangles.end());
}

}  // namespace greatx::rf
