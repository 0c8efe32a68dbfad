// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "scene/check/topology.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <map>
#include <numeric>
#include <unordered_map>

namespace greatx::scene::check {
namespace {

struct Cell {
  int64_t x, y, z;
  bool operator==(const Cell&) const = default;
};
struct CellHash {
  size_t operator()(const Cell& cell) const {
    uint64_t hash = static_cast<uint64_t>(cell.x) * 0x9E3779B97F4A7C15ull;
    hash = (hash ^ (hash >> 29) ^ static_cast<uint64_t>(cell.y)) * 0xBF58476D1CE4E5B9ull;
    hash = (hash ^ (hash >> 32) ^ static_cast<uint64_t>(cell.z)) * 0x94D049BB133111EBull;
    return hash ^ (hash >> 31);
  }
};

/// Returns the bits of a place; -0 and 0 are the same.
Cell bits_of(const dvec3& p) {
  return {std::bit_cast<int64_t>(p.x + 0.0), std::bit_cast<int64_t>(p.y + 0.0),
          std::bit_cast<int64_t>(p.z + 0.0)};
}

/// One side of a triangle between two corner numbers.
struct Side {
  uint32_t low, high, side;  ///< side: 3 * triangle + 0..2
  auto operator<=>(const Side&) const = default;
};

uint32_t next_of(uint32_t side) { return side % 3 == 2 ? side - 2 : side + 1; }

/// Calls visit(sides of one edge) for the triangles [first, first + count).
template <typename Visit>
void for_each_edge(const std::vector<uint32_t>& corners, uint32_t first, uint32_t count, const Visit& visit) {
  std::vector<Side> sides;
  sides.reserve(size_t{3} * count);
  for (uint32_t side = 3 * first; side < 3 * (first + count); ++side) {
    const uint32_t a = corners[side], b = corners[next_of(side)];
    const uint32_t c = corners[next_of(next_of(side))];
    if (a != b && b != c && c != a) sides.push_back({std::min(a, b), std::max(a, b), side});
  }
  std::ranges::sort(sides);
  for (size_t at = 0; at < sides.size();) {
    size_t end = at + 1;
    while (end < sides.size() && sides[end].low == sides[at].low && sides[end].high == sides[at].high) ++end;
    visit(std::span<const Side>(sides).subspan(at, end - at));
    at = end;
  }
}

/// An end of open edges.
struct End {
  dvec3 place;
  uint32_t corner = 0;
  double reach = 0.0;  ///< how far away a corner may be that it is welded to
};

/// Welds the ends of open edges of one object.
class Welder {
 public:
  explicit Welder(double most) : most_(most) {}

  /// Returns the nearest of the ends before it that are within both reaches, or the corner itself if there is
  /// none.
  uint32_t weld(const End& end) {
    const Cell cell{cell_of(end.place.x, most_), cell_of(end.place.y, most_), cell_of(end.place.z, most_)};
    uint32_t found = end.corner;
    double nearest = end.reach;
    for (int i = 0; i < 27; ++i) {
      const auto at = cells_.find({cell.x + i % 3 - 1, cell.y + i / 3 % 3 - 1, cell.z + i / 9 - 1});
      if (at == cells_.end()) continue;
      for (const End& other : at->second) {
        const double d = glm::distance(other.place, end.place);
        if (d > std::min(nearest, other.reach) || (d == nearest && found != end.corner)) continue;
        nearest = d, found = other.corner;
      }
    }
    if (found == end.corner) cells_[cell].push_back(end);
    return found;
  }

 private:
  double most_;
  std::unordered_map<Cell, std::vector<End>, CellHash> cells_;
};

class Maker {
 public:
  Maker(const Soup& soup, double weld_m) : soup_(soup), weld_m_(weld_m) {}

  Topology make() {
    result_.corners.resize(3 * soup_.triangles.size());
    result_.part.assign(soup_.triangles.size(), nothing);
    result_.turned.assign(soup_.triangles.size(), 0);
    neighbors_.assign(3 * soup_.triangles.size(), nothing);
    for (uint32_t object = 0; object < soup_.objects.size(); ++object) add_object(object);
    return std::move(result_);
  }

 private:
  const dvec3& place(uint32_t side) const { return soup_.triangles[side / 3].corners[side % 3]; }

  void add_object(uint32_t object) {
    const SoupObject& range = soup_.objects[object];
    weld_exactly(range);
    if (weld_m_ > 0.0) weld_open_ends(range);
    for_each_edge(result_.corners, range.first, range.count, [&](std::span<const Side> edge) {
      if (edge.size() != 2) return;
      neighbors_[edge[0].side] = edge[1].side;
      neighbors_[edge[1].side] = edge[0].side;
    });
    const size_t first_part = result_.parts.size();
    for (uint32_t t = range.first; t < range.first + range.count; ++t)
      if (result_.part[t] == nothing) add_part(object, t);
    find_open_edges(range, first_part);
    for (size_t p = first_part; p < result_.parts.size(); ++p) judge(result_.parts[p]);
  }

  void weld_exactly(const SoupObject& range) {
    std::unordered_map<Cell, uint32_t, CellHash> numbers;
    numbers.reserve(range.count);
    for (uint32_t side = 3 * range.first; side < 3 * (range.first + range.count); ++side)
      result_.corners[side] = numbers.try_emplace(bits_of(place(side)), side).first->second;
  }

  void weld_open_ends(const SoupObject& range) {
    std::map<uint32_t, double> shortest;  // of the open edges at a corner
    for_each_edge(result_.corners, range.first, range.count, [&](std::span<const Side> edge) {
      if (edge.size() != 1) return;
      const double length = glm::distance(place(edge[0].low), place(edge[0].high));
      for (const uint32_t end : {edge[0].low, edge[0].high}) {
        double& least = shortest.try_emplace(end, length).first->second;
        least = std::min(least, length);
      }
    });
    Welder welder(weld_m_);
    std::unordered_map<uint32_t, uint32_t> moved;
    for (const auto& [corner, length] : shortest) {
      const End end{place(corner), corner, std::min(weld_m_, 0.1 * length)};
      if (const uint32_t other = welder.weld(end); other != corner) moved.emplace(corner, other);
    }
    if (moved.empty()) return;
    for (uint32_t side = 3 * range.first; side < 3 * (range.first + range.count); ++side)
      if (const auto found = moved.find(result_.corners[side]); found != moved.end())
        result_.corners[side] = found->second;
  }

  /// Walks over all triangles that hang on `seed` and turns them as the seed is.
  void add_part(uint32_t object, uint32_t seed) {
    const auto number = static_cast<uint32_t>(result_.parts.size());
    Part part;
    part.object = object;
    part.first = static_cast<uint32_t>(result_.part_triangles.size());
    std::vector<uint32_t> stack{seed};
    result_.part[seed] = number;
    while (!stack.empty()) {
      const uint32_t t = stack.back();
      stack.pop_back();
      result_.part_triangles.push_back(t);
      part.area_m2 += soup_.areas[t];
      for (const dvec3& corner : soup_.triangles[t].corners) part.bounds.add(corner);
      for (uint32_t side = 3 * t; side < 3 * t + 3; ++side) {
        const uint32_t opposite = neighbors_[side];
        if (opposite == nothing) continue;
        // Neighbours of one orientation walk along their edge in opposite directions.
        const bool same_way = result_.corners[side] == result_.corners[opposite];
        const uint8_t turned = result_.turned[t] ^ (same_way ? 1 : 0);
        if (result_.part[opposite / 3] == nothing) {
          result_.part[opposite / 3] = number;
          result_.turned[opposite / 3] = turned;
          stack.push_back(opposite / 3);
        } else if (result_.turned[opposite / 3] != turned) {
          part.one_sided = false;
        }
      }
    }
    part.count = static_cast<uint32_t>(result_.part_triangles.size()) - part.first;
    std::sort(result_.part_triangles.begin() + part.first, result_.part_triangles.end());
    result_.parts.push_back(std::move(part));
  }

  void find_open_edges(const SoupObject& range, size_t first_part) {
    std::vector<std::vector<OpenEdge>> edges(result_.parts.size() - first_part);
    std::vector<std::pair<uint32_t, uint32_t>> by_part;  // part, side
    for_each_edge(result_.corners, range.first, range.count, [&](std::span<const Side> edge) {
      // The sides by part: most edges have one or two, but a fan has thousands about one edge.
      by_part.clear();
      for (const Side& side : edge) by_part.emplace_back(result_.part[side.side / 3], side.side);
      std::ranges::sort(by_part);
      for (size_t i = 0; i < by_part.size(); ++i) {
        const auto [part, side] = by_part[i];
        const bool alone = (i == 0 || by_part[i - 1].first != part) &&
                           (i + 1 == by_part.size() || by_part[i + 1].first != part);
        if (!alone) continue;
        const uint32_t end = next_of(side);
        const uint32_t other = by_part.size() == 1 ? nothing : by_part[i > 0 ? i - 1 : 1].first;
        edges[part - first_part].push_back(
            {side / 3, place(side), place(end), result_.corners[side], result_.corners[end], other});
      }
    });
    for (size_t i = 0; i < edges.size(); ++i) {
      std::ranges::sort(edges[i], {}, [](const OpenEdge& e) { return std::pair(e.triangle, e.from); });
      add_loops(result_.parts[first_part + i], edges[i]);
    }
  }

  /// Groups the open edges of a part by common ends.
  void add_loops(Part& part, const std::vector<OpenEdge>& edges) {
    std::unordered_map<uint32_t, uint32_t> loop_of;  // corner -> index of a parent
    std::vector<uint32_t> parents(edges.size());
    std::iota(parents.begin(), parents.end(), 0u);
    const auto root = [&](uint32_t i) {
      while (parents[i] != i) i = parents[i] = parents[parents[i]];
      return i;
    };
    for (uint32_t i = 0; i < edges.size(); ++i)
      for (const uint32_t corner : {edges[i].from, edges[i].to}) {
        const uint32_t other = root(loop_of.try_emplace(corner, i).first->second), mine = root(i);
        parents[std::max(other, mine)] = std::min(other, mine);
      }
    std::unordered_map<uint32_t, size_t> numbers;
    for (uint32_t i = 0; i < edges.size(); ++i) {
      const size_t at = numbers.try_emplace(root(i), part.loops.size()).first->second;
      if (at == part.loops.size()) part.loops.emplace_back();
      part.loops[at].edges.push_back(static_cast<uint32_t>(result_.open_edges.size()));
      result_.open_edges.push_back(edges[i]);
    }
    for (Loop& loop : part.loops) measure(loop);
  }

  void measure(Loop& loop) {
    for (const uint32_t e : loop.edges) {
      const OpenEdge& edge = result_.open_edges[e];
      loop.center += 0.5 * (edge.a + edge.b) / static_cast<double>(loop.edges.size());
      loop.length_m += glm::distance(edge.a, edge.b);
    }
    for (const uint32_t e : loop.edges) {
      const OpenEdge& edge = result_.open_edges[e];
      const dvec3 twice = glm::cross(edge.a - loop.center, edge.b - loop.center);
      loop.cap_m2 += 0.5 * glm::length(twice);
      loop.cap_normal += 0.5 * (result_.turned[edge.triangle] ? -twice : twice);
    }
  }

  bool is_nearly_closed(const Part& part) const {
    double caps = 0.0;
    for (const Loop& loop : part.loops) caps += loop.cap_m2;
    if (caps > most_cap_share * part.area_m2) return false;
    return std::ranges::all_of(part.loops, [&](const Loop& loop) {
      const double length = glm::length(loop.cap_normal);
      if (!(length > 0.0)) return true;
      double shadow = 0.0;
      for (const uint32_t t : result_.triangles_of(part))
        shadow += 0.5 * soup_.areas[t] * std::abs(glm::dot(soup_.normals[t], loop.cap_normal / length));
      return length <= most_cap_by_shadow * shadow;
    });
  }

  /// Decides what a part is, and turns it outwards.
  void judge(Part& part) {
    if (!part.loops.empty()) part.kind = is_nearly_closed(part) ? PartKind::nearly_closed : PartKind::sheet;
    // A triangle that welding has left without area has no edges, but closes nothing.
    if (part.loops.empty() && part.count < 2) part.kind = PartKind::sheet;
    const std::span<const uint32_t> triangles = result_.triangles_of(part);
    double turned_area = 0.0;
    for (const uint32_t t : triangles) turned_area += result_.turned[t] ? soup_.areas[t] : 0.0;
    bool turn = turned_area > 0.5 * part.area_m2;
    if (part.kind != PartKind::sheet) {
      part.volume_m3 = volume(part);
      turn = part.volume_m3 < 0.0;
      part.volume_m3 = std::abs(part.volume_m3);
    }
    if (turn)
      for (const uint32_t t : triangles) result_.turned[t] ^= 1;
  }

  double volume(const Part& part) const {
    const dvec3 origin = part.bounds.center();
    double six = 0.0;
    for (const uint32_t t : result_.triangles_of(part)) {
      const dvec3* c = soup_.triangles[t].corners;
      const double one = glm::dot(c[0] - origin, glm::cross(c[1] - origin, c[2] - origin));
      six += result_.turned[t] ? -one : one;
    }
    for (const Loop& loop : part.loops)
      for (const uint32_t e : loop.edges) {
        const OpenEdge& edge = result_.open_edges[e];
        const double cap = glm::dot(loop.center - origin, glm::cross(edge.b - origin, edge.a - origin));
        six += result_.turned[edge.triangle] ? -cap : cap;
      }
    return six / 6.0;
  }

  const Soup& soup_;
  double weld_m_;
  Topology result_;
  std::vector<uint32_t> neighbors_;  ///< [3 * triangles] the side across an edge of two triangles
};

}  // namespace

Topology make_topology(const Soup& soup, double weld_m) { return Maker(soup, weld_m).make(); }

}  // namespace greatx::scene::check
