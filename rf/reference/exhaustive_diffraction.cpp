// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "rf/reference/exhaustive_diffraction.h"

#include <algorithm>
#include <cmath>
#include <optional>

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
          if (before.chains[a].facets.size() + after.chains[b].facets.size() + 1 <= options_.max_depth)
            try_pair(w, before.chains[a], after.chains[b], paths);
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

  void try_pair(uint32_t index, const Chain& before, const Chain& after,
                std::vector<GeometricPath>& paths) const {
    const scene::Wedge& wedge = wedges_[index];
    const dvec3 &a = before.images.back(), &b = after.images.back();
    const std::optional<dvec3> point = shortest(wedge, a, b);
    if (!point) return;
    std::vector<dvec3> out, home;
    if (!chains_.reflect(before, *point, out) || !chains_.reflect(after, *point, home)) return;
    if (!outside(wedge, out[out.size() - 2]) || !outside(wedge, home[home.size() - 2])) return;
    GeometricPath path;
    path.vertices = out;
    path.vertices.insert(path.vertices.end(), home.rbegin() + 1, home.rend());
    for (const uint32_t facet : before.facets)
      path.interactions.push_back({InteractionType::reflection, facet, 0});
    path.interactions.push_back({InteractionType::diffraction, index, 0});
    for (auto facet = after.facets.rbegin(); facet != after.facets.rend(); ++facet)
      path.interactions.push_back({InteractionType::reflection, *facet, 0});
    path.length_m = glm::distance(a, *point) + glm::distance(*point, b);
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
