// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "renderer/surface/closed_bodies.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <map>
#include <numeric>
#include <span>
#include <unordered_map>
#include <utility>

#include "core/units.h"
#include "renderer/surface/pane_color.h"

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

/// The triangles of a mesh, three corners each, with what they show of their connected parts.
class Parts {
 public:
  explicit Parts(std::span<const vec3> corners);

  /// The part of a triangle: the number of one of its corners.
  uint32_t of(size_t triangle) const { return part_[triangle]; }
  /// Whether a part is a closed surface that faces outwards.
  bool closed(uint32_t part) const { return balanced_[part] && volume_[part] > 0.0; }

 private:
  std::vector<uint32_t> part_;
  std::vector<bool> balanced_;  ///< by part
  std::vector<double> volume_;  ///< by part, six times
};

Parts::Parts(std::span<const vec3> corners) {
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
  balanced_.assign(count, true);
  std::ranges::sort(edges);
  for (size_t i = 0; i < edges.size();) {
    int sum = 0;
    const uint64_t edge = edges[i].first;
    for (; i < edges.size() && edges[i].first == edge; ++i) sum += edges[i].second;
    if (sum != 0) balanced_[root(static_cast<uint32_t>(edge))] = false;
  }
  volume_.assign(count, 0.0);
  for (size_t t = 0; t < at.size(); t += 3) {
    // Volumes are taken about a corner of the body, so that they do not depend on its origin.
    const dvec3 o(corners[0]), a = dvec3(corners[t]) - o, b = dvec3(corners[t + 1]) - o,
                               c = dvec3(corners[t + 2]) - o;
    part_.push_back(root(at[t]));
    volume_[part_.back()] += glm::dot(a, glm::cross(b, c));
  }
}

/// Returns whether the triangles, three corners each, are closed and face outwards.
bool closed(std::span<const vec3> corners) {
  const Parts parts(corners);
  for (size_t t = 0; t < corners.size() / 3; ++t)
    if (!parts.closed(parts.of(t))) return false;
  return true;
}

using Corners = std::array<dvec3, 3>;

/// Returns six times the volume of a tetrahedron; its sign says on which side of the triangle d lies.
double volume(const dvec3& a, const dvec3& b, const dvec3& c, const dvec3& d) {
  return glm::dot(glm::cross(b - a, c - a), d - a);
}

/// Returns whether an edge of `a` passes through `b` or its rim.
bool pierces(const Corners& a, const Corners& b) {
  for (size_t k = 0; k < 3; ++k) {
    const dvec3 p = a[k], q = a[(k + 1) % 3];
    if (volume(b[0], b[1], b[2], p) * volume(b[0], b[1], b[2], q) >= 0.0) continue;
    const double u = volume(p, q, b[0], b[1]), v = volume(p, q, b[1], b[2]), w = volume(p, q, b[2], b[0]);
    if (std::min({u, v, w}) >= 0.0 || std::max({u, v, w}) <= 0.0) return true;
  }
  return false;
}

bool cross(const Corners& a, const Corners& b) {
  for (int axis = 0; axis < 3; ++axis) {
    const auto ends = [&](const Corners& t) { return std::minmax({t[0][axis], t[1][axis], t[2][axis]}); };
    const std::pair<double, double> i = ends(a), j = ends(b);
    if (i.second < j.first || j.second < i.first) return false;
  }
  return pierces(a, b) || pierces(b, a);
}

/// Returns how often closed triangles wind around a point (van Oosterom and Strackee 1983).
double winding_number(std::span<const Corners> triangles, const dvec3& point) {
  double angle = 0.0;
  for (const Corners& t : triangles) {
    const dvec3 a = t[0] - point, b = t[1] - point, c = t[2] - point;
    const double x = glm::length(a), y = glm::length(b), z = glm::length(c);
    angle += 2.0 * std::atan2(glm::dot(a, glm::cross(b, c)),
                              x * y * z + glm::dot(a, b) * z + glm::dot(b, c) * x + glm::dot(c, a) * y);
  }
  return angle / (4.0 * pi);
}

/// A body, or an instance of the static world: the primitives that may hide and be hidden.
struct Group {
  std::vector<uint32_t> primitives;
  std::vector<vec3> corners;
  std::vector<uint32_t> owner;  ///< of each triangle: the place of its primitive in `primitives`
  std::vector<bool> panes;      ///< by place
  bool any_pane = false;

  void add(const scene::Scene& scene, uint32_t primitive, bool pane) {
    const auto place = static_cast<uint32_t>(primitives.size());
    primitives.push_back(primitive);
    panes.push_back(pane);
    any_pane |= pane;
    const scene::Primitive& range = scene.primitives[primitive];
    for (uint32_t k = 0; k < range.index_count; ++k)
      corners.push_back(scene.positions[scene.indices[range.first_index + k]]);
    owner.insert(owner.end(), range.index_count / 3, place);
  }
};

/// Of meshes with more pairs of a shell's triangle and another one, nothing counts as inside: a vehicle has
/// some hundred thousand, and each takes some 10 ns at set-up.
constexpr size_t most_pairs = 4'000'000;

/// Returns which primitives of a group are insides, by place.
std::vector<bool> insides_of(const Group& group) {
  const Parts parts(group.corners);
  const size_t count = group.owner.size();
  const auto triangle = [&](size_t t) {
    const vec3* c = &group.corners[3 * t];
    return Corners{dvec3(c[0]), dvec3(c[1]), dvec3(c[2])};
  };
  // The surfaces with panes.
  std::vector<bool> outer(group.corners.size(), false);
  for (size_t t = 0; t < count; ++t)
    if (group.panes[group.owner[t]] && parts.closed(parts.of(t))) outer[parts.of(t)] = true;
  std::vector<Corners> shell;
  for (size_t t = 0; t < count; ++t)
    if (outer[parts.of(t)]) shell.push_back(triangle(t));
  const bool few = shell.size() * (count - shell.size()) <= most_pairs;
  std::vector<bool> inside(group.primitives.size(), few && !shell.empty());
  if (!few) return inside;
  enum class Where : uint8_t { unknown, in, out };
  std::vector<Where> where(group.corners.size(), Where::unknown);  // by part
  for (size_t t = 0; t < count; ++t) {
    Where& of_part = where[parts.of(t)];
    if (outer[parts.of(t)] || of_part == Where::out) continue;
    const Corners c = triangle(t);
    if (of_part == Where::unknown)
      of_part = winding_number(shell, (c[0] + c[1] + c[2]) / 3.0) > 0.5 ? Where::in : Where::out;
    if (of_part == Where::in && std::ranges::any_of(shell, [&](const Corners& s) { return cross(s, c); }))
      of_part = Where::out;
  }
  for (size_t t = 0; t < count; ++t)
    if (where[parts.of(t)] != Where::in) inside[group.owner[t]] = false;
  return inside;
}

}  // namespace

std::vector<bool> closed_bodies(const scene::Scene& scene, const std::vector<bool>& insides) {
  std::vector<bool> result(scene.bodies.size(), false);
  // Many bodies are the same model.
  std::map<std::vector<uint32_t>, bool> known;
  for (uint32_t body = 1; body < scene.bodies.size(); ++body) {
    const scene::Body& range = scene.bodies[body];
    std::vector<vec3> corners;
    bool has_holes = false;
    for (uint32_t i = range.first_primitive; i < range.first_primitive + range.primitive_count; ++i) {
      const scene::Primitive& primitive = scene.primitives[i];
      if (!insides.empty() && insides[i]) continue;
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

std::vector<bool> closed_instances(const scene::Scene& scene, const std::vector<bool>& insides) {
  std::vector<std::vector<vec3>> corners(scene.instances.size());
  const scene::Body& world = scene.bodies[0];
  for (uint32_t i = world.first_primitive; i < world.first_primitive + world.primitive_count; ++i) {
    const scene::Primitive& primitive = scene.primitives[i];
    if (scene.has_holes(i) || (!insides.empty() && insides[i])) continue;
    for (uint32_t k = 0; k < primitive.index_count; ++k)
      corners[primitive.instance].push_back(scene.positions[scene.indices[primitive.first_index + k]]);
  }
  std::vector<bool> result(scene.instances.size(), false);
  for (size_t i = 0; i < corners.size(); ++i) result[i] = !corners[i].empty() && closed(corners[i]);
  return result;
}

std::vector<bool> insides(const scene::Scene& scene) {
  const std::vector<bool> is_pane = pane_materials(scene);
  std::vector<bool> result(scene.primitives.size(), false);
  // Many bodies are the same model.
  std::map<std::vector<uint32_t>, std::vector<bool>> known;
  const auto find = [&](const Group& group) {
    if (!group.any_pane) return;
    std::vector<uint32_t> words;
    for (const vec3& corner : group.corners)
      for (int c = 0; c < 3; ++c) words.push_back(std::bit_cast<uint32_t>(corner[c]));
    for (size_t i = 0; i < group.primitives.size(); ++i)
      words.push_back(scene.primitives[group.primitives[i]].index_count << 1 | uint32_t{group.panes[i]});
    const auto [at, is_new] = known.try_emplace(std::move(words));
    if (is_new) at->second = insides_of(group);
    for (size_t i = 0; i < group.primitives.size(); ++i) result[group.primitives[i]] = at->second[i];
  };
  for (uint32_t body = 0; body < scene.bodies.size(); ++body) {
    const scene::Body& range = scene.bodies[body];
    Group group;
    for (uint32_t i = range.first_primitive; i < range.first_primitive + range.primitive_count; ++i) {
      const scene::Primitive& primitive = scene.primitives[i];
      const bool next = body == 0 && !group.primitives.empty() &&
                        primitive.instance != scene.primitives[group.primitives.back()].instance;
      if (next) {
        find(group);
        group = {};
      }
      if (!scene.has_holes(i)) group.add(scene, i, is_pane[primitive.material]);
    }
    find(group);
  }
  return result;
}

ClosedSurfaces closed_surfaces(const scene::Scene& scene) {
  ClosedSurfaces found{insides(scene), {}, {}};
  found.bodies = closed_bodies(scene, found.insides);
  found.instances = closed_instances(scene, found.insides);
  return found;
}

}  // namespace greatx::render
