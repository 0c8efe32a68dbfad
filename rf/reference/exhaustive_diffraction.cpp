// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "rf/reference/exhaustive_diffraction.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include "core/error.h"
#include "core/parallel.h"
#include "core/units.h"
#include "rf/reference/chains.h"

namespace greatx::rf::reference {
namespace {

/// Returns the angle of a point about the edge, from face 0 into the exterior, 0 to 2 pi.
double angle_of(const scene::Wedge& wedge, const dvec3& point) {
  const dvec3 from = point - wedge.a;
  const double angle = std::atan2(glm::dot(from, wedge.normal_0), glm::dot(from, wedge.tangent_0));
  return angle < 0.0 ? angle + 2.0 * pi : angle;
}

/// Tells whether a point is in the exterior. A point on a face may have any rounding of its angle.
bool outside(const scene::Wedge& wedge, const dvec3& point) {
  constexpr double room = 1e-7;
  const double angle = angle_of(wedge, point);
  return angle <= wedge.n * pi + room || angle >= 2.0 * pi - room;
}

/// Returns the point of the edge for which the way from `a` to `b` is shortest, if it lies between the ends.
/// The slope of the length along the edge rises, so that bisection finds its zero.
std::optional<dvec3> shortest(const scene::Wedge& wedge, const dvec3& a, const dvec3& b) {
  const double length = glm::distance(wedge.a, wedge.b);
  const dvec3 along = (wedge.b - wedge.a) / length;
  const auto slope = [&](double z) {
    const dvec3 point = wedge.a + z * along, from = point - a, to = point - b;
    return glm::dot(along, from) / glm::length(from) + glm::dot(along, to) / glm::length(to);
  };
  double low = 0.0, high = length;
  if (!(slope(low) <= 0.0 && slope(high) >= 0.0)) return std::nullopt;
  for (int i = 0; i < 64; ++i) {
    const double middle = 0.5 * (low + high);
    (slope(middle) <= 0.0 ? low : high) = middle;
  }
  return wedge.a + 0.5 * (low + high) * along;
}

/// Returns the place on the line of an edge between two points, by unfolding them about it.
double unfolded_place(const scene::Wedge& wedge, const dvec3& along, const dvec3& a, const dvec3& b) {
  const double z_a = glm::dot(a - wedge.a, along), z_b = glm::dot(b - wedge.a, along);
  const double from_a = glm::distance(a, wedge.a + z_a * along),
               from_b = glm::distance(b, wedge.a + z_b * along);
  return from_a + from_b > 0.0 ? z_a + (z_b - z_a) * from_a / (from_a + from_b) : z_a;
}

/// Returns the points of both edges for which the way from `a` to `b` is shortest, if they lie between the
/// ends. With the best second point for each first one, the slope along the first edge rises.
std::optional<std::pair<dvec3, dvec3>> shortest(const scene::Wedge& first, const scene::Wedge& second,
                                                const dvec3& a, const dvec3& b) {
  const double length_1 = glm::distance(first.a, first.b), length_2 = glm::distance(second.a, second.b);
  const dvec3 along_1 = (first.b - first.a) / length_1, along_2 = (second.b - second.a) / length_2;
  dvec3 p(0.0), q(0.0);
  double z_2 = 0.0;
  const auto slope = [&](double z) {
    p = first.a + z * along_1;
    z_2 = unfolded_place(second, along_2, p, b);
    q = second.a + z_2 * along_2;
    const dvec3 from = p - a, to = p - q;
    return glm::dot(along_1, from) / glm::length(from) + glm::dot(along_1, to) / glm::length(to);
  };
  const auto meet = [&](double z) { return std::isnan(slope(z)) || glm::distance(p, q) < 1e-9; };
  // Where the edges meet, the way has no slope.
  double low = 0.0, high = length_1;
  if (meet(low)) low += 1e-6 * length_1;
  if (meet(high)) high -= 1e-6 * length_1;
  if (!(slope(low) <= 0.0 && slope(high) >= 0.0)) return std::nullopt;
  for (int i = 0; i < 60; ++i) {
    const double middle = 0.5 * (low + high);
    (slope(middle) <= 0.0 ? low : high) = middle;
  }
  slope(0.5 * (low + high));
  if (z_2 < 0.0 || z_2 > length_2 || glm::distance(p, q) < 1e-3) return std::nullopt;
  return std::pair(p, q);
}

/// Returns how much longer the way over an end of an edge is than over any place of its line.
double excess_over_end(const scene::Wedge& wedge, const dvec3& end, const dvec3& a, const dvec3& b) {
  const dvec3 along = glm::normalize(wedge.b - wedge.a);
  const dvec3 best = wedge.a + unfolded_place(wedge, along, a, b) * along;
  return glm::distance(a, end) + glm::distance(end, b) - glm::distance(a, best) - glm::distance(best, b);
}

/// Returns the place from which an end of an edge is seen.
dvec3 seen_beside(const scene::Wedge& wedge, bool at_b) {
  const double share = std::min(2e-3 / glm::distance(wedge.a, wedge.b), 0.5);
  return at_b ? glm::mix(wedge.b, wedge.a, share) : glm::mix(wedge.a, wedge.b, share);
}

/// Holds all sequences from one end, and which of them may lead to which wedge.
struct Side {
  std::vector<Chain> chains;
  std::vector<std::vector<uint32_t>> at;  ///< [wedges] indices of chains
};

class EdgePaths {
 public:
  EdgePaths(const scene::Scene& scene, const FacetWorld& world, std::span<const Pose> body_poses,
            const FacetKinds& kinds, std::span<const scene::Wedge> wedges, const DiffractionOptions& options)
      : chains_(scene, world, body_poses, kinds),
        wedges_(wedges),
        options_(options),
        beside_(std::min(options.max_beside, std::max(options.max_depth, 1u) - 1)) {}

  Side side_of(const dvec3& end) const {
    Side side;
    side.at.resize(wedges_.size());
    std::vector<std::vector<HalfSpace>> half_spaces(beside_ + 1);
    Chain chain{{}, {}, {end}};
    grow(chain, half_spaces, side);
    return side;
  }

  std::vector<GeometricPath> join(const Side& before, const Side& after) const {
    std::vector<GeometricPath> paths;
    for (uint32_t w = 0; w < wedges_.size(); ++w)
      for (const uint32_t a : before.at[w])
        for (const uint32_t b : after.at[w])
          if (before.chains[a].facets.size() + after.chains[b].facets.size() + 1 <= options_.max_depth) {
            try_pair(w, before.chains[a], after.chains[b], paths);
            for (const bool at_b : {false, true})
              if (!options_.open_ends.empty() && options_.open_ends[w][at_b])
                try_end(w, at_b, before.chains[a], after.chains[b], paths);
          }
    for (uint32_t v = 0; options_.max_edges > 1 && v < wedges_.size(); ++v)
      for (uint32_t w = 0; w < wedges_.size(); ++w)
        if (v != w) join_pair(v, w, before, after, paths);
    std::sort(paths.begin(), paths.end(), [](const GeometricPath& a, const GeometricPath& b) {
      return interactions_less(a.interactions, b.interactions);
    });
    return paths;
  }

 private:
  void grow(Chain& chain, std::vector<std::vector<HalfSpace>>& half_spaces, Side& side) const {
    const size_t depth = chain.facets.size();
    if (depth > 0) chains_.view(chain, half_spaces[depth - 1], half_spaces[depth]);
    note(chain, half_spaces[depth], side);
    if (depth == beside_) return;
    const auto extend = [&](uint32_t facet) {
      if (!chains_.push(chain, facet)) return;
      grow(chain, half_spaces, side);
      Chains::pop(chain);
    };
    if (depth == 0)
      for (const uint32_t facet : chains_.facets()) extend(facet);
    else
      chains_.next(std::vector(half_spaces[depth]), extend);
  }

  void note(const Chain& chain, const std::vector<HalfSpace>& half_spaces, Side& side) const {
    const auto index = static_cast<uint32_t>(side.chains.size());
    side.chains.push_back(chain);
    for (uint32_t w = 0; w < wedges_.size(); ++w) {
      const scene::Wedge& wedge = wedges_[w];
      if (!chain.facets.empty() &&
          (chain.facets.back() == wedge.facet_0 || chain.facets.back() == wedge.facet_n))
        continue;
      const bool may_reach = std::all_of(half_spaces.begin(), half_spaces.end(), [&](const HalfSpace& half) {
        return half.depth(wedge.a) >= 0.0 || half.depth(wedge.b) >= 0.0;
      });
      if (may_reach) side.at[w].push_back(index);
    }
  }

  void join_pair(uint32_t v, uint32_t w, const Side& before, const Side& after,
                 std::vector<GeometricPath>& paths) const {
    for (const uint32_t a : before.at[v])
      for (const uint32_t b : after.at[w])
        if (before.chains[a].facets.size() + after.chains[b].facets.size() + 2 <= options_.max_depth)
          try_both(v, w, before.chains[a], after.chains[b], paths);
  }

  void try_both(uint32_t v, uint32_t w, const Chain& before, const Chain& after,
                std::vector<GeometricPath>& paths) const {
    const scene::Wedge &first = wedges_[v], &second = wedges_[w];
    const dvec3 &a = before.images.back(), &b = after.images.back();
    const auto points = shortest(first, second, a, b);
    if (!points || !outside(first, points->second) || !outside(second, points->first)) return;
    std::vector<dvec3> out, home;
    if (!chains_.reflect(before, points->first, out) || !chains_.reflect(after, points->second, home)) return;
    if (!outside(first, out[out.size() - 2]) || !outside(second, home[home.size() - 2])) return;
    add_path(before, {v, w}, after, out, home,
             glm::distance(a, points->first) + glm::distance(points->first, points->second) +
                 glm::distance(points->second, b),
             paths);
  }

  void try_pair(uint32_t index, const Chain& before, const Chain& after,
                std::vector<GeometricPath>& paths) const {
    const scene::Wedge& wedge = wedges_[index];
    const dvec3 &a = before.images.back(), &b = after.images.back();
    const std::optional<dvec3> point = shortest(wedge, a, b);
    if (!point) return;
    std::vector<dvec3> out, home;
    if (!chains_.reflect(before, *point, out) || !chains_.reflect(after, *point, home)) return;
    if (!outside(wedge, out[out.size() - 2]) || !outside(wedge, home[home.size() - 2])) return;
    home.pop_back();  // the point is in both
    add_path(before, {index}, after, out, home, glm::distance(a, *point) + glm::distance(*point, b), paths);
  }

  /// Tells whether the last facet of a chain meets in the end of an edge.
  bool meets(const Chain& chain, const dvec3& end) const {
    return !chain.facets.empty() &&
           std::abs(chains_.world().facet(chain.facets.back()).distance(end)) <= 2e-4;
  }

  void try_end(uint32_t index, bool at_b, const Chain& before, const Chain& after,
               std::vector<GeometricPath>& paths) const {
    const scene::Wedge& wedge = wedges_[index];
    const dvec3 &a = before.images.back(), &b = after.images.back(), &end = at_b ? wedge.b : wedge.a;
    if (excess_over_end(wedge, end, a, b) > options_.most_excess_m) return;
    if (!outside(wedge, a) || !outside(wedge, b) || meets(before, end) || meets(after, end)) return;
    std::vector<dvec3> out, home;
    if (!chains_.reflect(before, end, out) || !chains_.reflect(after, end, home)) return;
    if (!outside(wedge, out[out.size() - 2]) || !outside(wedge, home[home.size() - 2])) return;
    home.pop_back();
    out.back() = seen_beside(wedge, at_b);
    const size_t already = paths.size();
    add_path(before, {index}, after, out, home, glm::distance(a, end) + glm::distance(end, b), paths);
    if (paths.size() == already) return;
    move_to_end(paths.back(), end, at_b);
  }

  /// Moves the vertex beside an end into the end, and walls passed onto the straight lines to it.
  void move_to_end(GeometricPath& path, const dvec3& end, bool at_b) const {
    std::vector<size_t> turns{0};
    for (size_t i = 0; i < path.interactions.size(); ++i) {
      if (path.interactions[i].type == InteractionType::transmission) continue;
      turns.push_back(i + 1);
      if (path.interactions[i].type != InteractionType::diffraction) continue;
      path.interactions[i].patch = at_b ? 2 : 1;
      path.vertices[i + 1] = end;
    }
    turns.push_back(path.vertices.size() - 1);
    for (size_t run = 0; run + 1 < turns.size(); ++run) {
      const dvec3 a = path.vertices[turns[run]], b = path.vertices[turns[run + 1]];
      for (size_t i = turns[run] + 1; i < turns[run + 1]; ++i) {
        const PosedFacet& wall = chains_.world().facet(path.interactions[i - 1].element);
        const double from = wall.distance(a), to = wall.distance(b);
        path.vertices[i] = a + from / (from - to) * (b - a);
      }
    }
  }

  /// Adds a path if nothing is in its way. `out` runs from the transmitter to the first edge, `home` from the
  /// receiver to the last edge, or to the vertex before if there is one edge.
  void add_path(const Chain& before, const std::vector<uint32_t>& edges, const Chain& after,
                const std::vector<dvec3>& out, const std::vector<dvec3>& home, double length_m,
                std::vector<GeometricPath>& paths) const {
    GeometricPath path;
    path.vertices = out;
    path.vertices.insert(path.vertices.end(), home.rbegin(), home.rend());
    for (const uint32_t facet : before.facets)
      path.interactions.push_back({InteractionType::reflection, facet, 0});
    for (const uint32_t edge : edges) path.interactions.push_back({InteractionType::diffraction, edge, 0});
    for (auto facet = after.facets.rbegin(); facet != after.facets.rend(); ++facet)
      path.interactions.push_back({InteractionType::reflection, *facet, 0});
    path.length_m = length_m;
    if (chains_.pass_walls(path, {options_.max_depth, options_.max_transmissions, 0, 0}, wedges_))
      paths.push_back(std::move(path));
  }

  Chains chains_;
  std::span<const scene::Wedge> wedges_;
  const DiffractionOptions& options_;
  uint32_t beside_;
};

}  // namespace

std::vector<std::vector<GeometricPath>> exhaustive_diffraction(
    const scene::Scene& scene, const FacetWorld& world, std::span<const Pose> body_poses,
    const FacetKinds& kinds, std::span<const scene::Wedge> wedges, const dvec3& transmitter,
    std::span<const dvec3> receivers, const DiffractionOptions& options) {
  GREATX_CHECK(options.max_depth > 0, "no interaction for a diffraction");
  for (const scene::Wedge& wedge : wedges) GREATX_CHECK(wedge.body == 0, "a wedge of body {}", wedge.body);
  const EdgePaths edges(scene, world, body_poses, kinds, wedges, options);
  const Side before = edges.side_of(transmitter);
  std::vector<std::vector<GeometricPath>> paths(receivers.size());
  parallel_for(receivers.size(), 0,
               [&](size_t r) { paths[r] = edges.join(before, edges.side_of(receivers[r])); });
  return paths;
}

}  // namespace greatx::rf::reference
