// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "renderer/surface/closed_bodies.h"

#include <algorithm>
#include <bit>
#include <cstdint>
#include <map>
#include <numeric>
#include <span>
#include <unordered_map>
#include <utility>

namespace greatx::render {

namespace {

/// Numbers places: corners at the same place get the same number.
class Places {
 public:
  uint32_t number(const vec3& p) {
    const Key key{std::bit_cast<uint32_t>(p.x + 0.0f), std::bit_cast<uint32_t>(p.y + 0.0f),
                  std::bit_cast<uint32_t>(p.z + 0.0f)};
    return numbers_.try_emplace(key, static_cast<uint32_t>(numbers_.size())).first->second;
  }

 private:
  struct Key {
    uint32_t x, y, z;
    bool operator==(const Key&) const = default;
  };
  struct Hash {
    size_t operator()(const Key& key) const {
      return (size_t{key.x} * 0x9e3779b97f4a7c15u ^ size_t{key.y} * 0xc2b2ae3d27d4eb4fu) +
             size_t{key.z} * 0x165667b19e3779f9u;
    }
  };
  std::unordered_map<Key, uint32_t, Hash> numbers_;
};

/// Returns whether the triangles, three corners each, are closed and face outwards.
bool closed(std::span<const vec3> corners) {
  Places places;
  std::vector<uint32_t> at;
  at.reserve(corners.size());
  uint32_t count = 0;
  for (const vec3& corner : corners) {
    at.push_back(places.number(corner));
    count = std::max(count, at.back() + 1);
  }
  std::vector<uint32_t> part(count);
  std::iota(part.begin(), part.end(), 0u);
  const auto root = [&](uint32_t i) {
    while (part[i] != i) i = part[i] = part[part[i]];
    return i;
  };
  // An edge counts up in one direction and down in the other. Closed surfaces leave nothing.
  std::vector<std::pair<uint64_t, int>> edges;
  edges.reserve(corners.size());
  for (size_t t = 0; t < at.size(); t += 3)
    for (size_t k = 0; k < 3; ++k) {
      const uint32_t a = at[t + k], b = at[t + (k + 1) % 3];
      edges.emplace_back(uint64_t{std::min(a, b)} << 32 | std::max(a, b), a < b ? 1 : -1);
      part[root(a)] = root(b);
    }
  std::ranges::sort(edges);
  for (size_t i = 0; i < edges.size();) {
    int sum = 0;
    const uint64_t edge = edges[i].first;
    for (; i < edges.size() && edges[i].first == edge; ++i) sum += edges[i].second;
    if (sum != 0) return false;
  }
  std::vector<double> volume(count, 0.0);
  for (size_t t = 0; t < at.size(); t += 3) {
    // Volumes are taken about a corner of the body, so that they do not depend on its origin.
    const dvec3 o(corners[0]), a = dvec3(corners[t]) - o, b = dvec3(corners[t + 1]) - o,
                               c = dvec3(corners[t + 2]) - o;
    volume[root(at[t])] += glm::dot(a, glm::cross(b, c));
  }
  for (uint32_t i = 0; i < count; ++i)
    if (root(i) == i && volume[i] <= 0.0) return false;
  return true;
}

}  // namespace

std::vector<bool> closed_bodies(const scene::Scene& scene) {
  std::vector<bool> result(scene.bodies.size(), false);
  // Many bodies are the same model.
  std::map<std::vector<uint32_t>, bool> known;
  for (uint32_t body = 1; body < scene.bodies.size(); ++body) {
    const scene::Body& range = scene.bodies[body];
    std::vector<vec3> corners;
    bool has_holes = false;
    for (uint32_t i = range.first_primitive; i < range.first_primitive + range.primitive_count; ++i) {
      const scene::Primitive& primitive = scene.primitives[i];
      has_holes |= scene.has_holes(i);
      for (uint32_t k = 0; k < primitive.index_count; ++k)
        corners.push_back(scene.positions[scene.indices[primitive.first_index + k]]);
    }
    if (corners.empty() || has_holes) continue;
    std::vector<uint32_t> words;
    words.reserve(3 * corners.size());
    for (const vec3& corner : corners)
      for (int c = 0; c < 3; ++c) words.push_back(std::bit_cast<uint32_t>(corner[c]));
    const auto [at, is_new] = known.try_emplace(std::move(words), false);
    if (is_new) at->second = closed(corners);
    result[body] = at->second;
  }
  return result;
}

std::vector<bool> closed_instances(const scene::Scene& scene) {
  std::vector<std::vector<vec3>> corners(scene.instances.size());
  const scene::Body& world = scene.bodies[0];
  for (uint32_t i = world.first_primitive; i < world.first_primitive + world.primitive_count; ++i) {
    const scene::Primitive& primitive = scene.primitives[i];
    if (scene.has_holes(i)) continue;
    for (uint32_t k = 0; k < primitive.index_count; ++k)
      corners[primitive.instance].push_back(scene.positions[scene.indices[primitive.first_index + k]]);
  }
  std::vector<bool> result(scene.instances.size(), false);
  for (size_t i = 0; i < corners.size(); ++i) result[i] = !corners[i].empty() && closed(corners[i]);
  return result;
}

}  // namespace greatx::render
