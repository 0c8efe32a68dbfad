// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Finds all paths with a scattering and another bend of small scenes, by trying every pair, and sums them.
#pragma once

#include <algorithm>
#include <cmath>
#include <map>
#include <vector>

#include "rf/channel/statistics.h"
#include "rf/paths/scatter_draw.h"
#include "rf/paths/scattering_patches.h"
#include "tests/rf/scattering_links.h"

namespace greatx::rf::testing {

enum class Kind : uint8_t { other, two_patches, edge_and_patch, patch_and_edge };

/// Returns the kind of a path as the wave runs.
inline Kind kind_of(const std::vector<Interaction>& interactions, bool from_receiver = false) {
  std::vector<InteractionType> bends;
  for (const Interaction& i : interactions)
    if (i.type == InteractionType::scattering || i.type == InteractionType::diffraction)
      bends.push_back(i.type);
  if (bends.size() != 2) return Kind::other;
  if (from_receiver) std::ranges::reverse(bends);
  if (bends[0] == bends[1]) return bends[0] == InteractionType::scattering ? Kind::two_patches : Kind::other;
  return bends[0] == InteractionType::diffraction ? Kind::edge_and_patch : Kind::patch_and_edge;
}

inline RadioEffects edges_and_patches(uint64_t seed = 1, bool walls = false) {
  RadioEffects effects = with_scattering(seed);
  effects.transmission = walls;
  effects.diffraction = true;
  return effects;
}

inline PathLimits both_kinds(uint32_t depth, uint32_t budget, double patch_m = 6.0) {
  return {.max_depth = depth,
          .max_reflections_beside_diffraction = 1,
          .max_reflections_before_scattering = 1,
          .patch_m = patch_m,
          .scattering_budget = budget,
          .max_scatterings = 2,
          .scattering_beside_diffraction = true};
}

/// Finds all pairs, by trying every one.
class AllPairs {
 public:
  AllPairs(const scene::Scene& scene, const dvec3& source, uint32_t depth, double patch_m, bool walls = false)
      : depth_(depth),
        ways_(scene, source, {.max_depth = depth, .max_reflections_beside_diffraction = 1},
              edges_alone(walls)),
        patches_(scattering_patches(scene, ways_.model().kinds, patch_m)) {}

  std::vector<GeometricPath> to(const dvec3& target) const {
    std::vector<GeometricPath> paths;
    for (const Patch& patch : patches_)
      for (const GeometricPath& way : ways_.geometry(patch.center)) {
        const bool bent =
            !way.interactions.empty() && way.interactions.back().type == InteractionType::diffraction;
        if (bent && way.interactions.size() <= 2) add(scattered_at(way, patch), target, paths);
        if (way.facets().size() < way.interactions.size() || way.interactions.size() > 1) continue;
        const GeometricPath first = scattered_at(way, patch);
        if (first.interactions.empty()) continue;
        for (const Patch& second : patches_) {
          GeometricPath to_second = first;
          to_second.vertices.push_back(second.center);
          to_second.length_m += glm::distance(patch.center, second.center);
          if (sends(patch, to_second)) add(scattered_at(to_second, second), target, paths);
        }
        add_edges(first, patch, target, paths);
      }
    return paths;
  }
  const Links& links() const { return ways_; }
  size_t patches() const { return patches_.size(); }

 private:
  static RadioEffects edges_alone(bool walls) {
    RadioEffects effects = edges_and_patches(1, walls);
    effects.scattering = false;
    return effects;
  }
  const PosedFacet& facet(const Patch& patch) const { return ways_.model().facets.facet(patch.facet); }

  /// Returns a way to a patch with the scattering as its last interaction, or an empty path.
  GeometricPath scattered_at(GeometricPath way, const Patch& patch) const {
    const double from = facet(patch).distance(way.vertices[way.vertices.size() - 2]);
    if (std::abs(from) <= facet(patch).tolerance_m || way.interactions.size() >= depth_) return {};
    way.interactions.push_back({InteractionType::scattering, patch.facet, patch.number});
    (way.patch_area_m2 > 0.0 ? way.second_patch_area_m2 : way.patch_area_m2) = patch.area_m2;
    return way;
  }
  /// Tells whether the path leaves its last patch on the side from which it came.
  bool sends(const Patch& patch, const GeometricPath& path) const {
    const size_t last = path.vertices.size() - 1;
    const double from = facet(patch).distance(path.vertices[last - 2]),
                 to = facet(patch).distance(path.vertices[last]);
    return std::abs(to) > facet(patch).tolerance_m && from * to > 0.0;
  }
  void add(GeometricPath path, const dvec3& target, std::vector<GeometricPath>& paths) const {
    if (path.interactions.empty()) return;
    const Interaction& last = path.interactions.back();
    const auto patch = std::ranges::find_if(
        patches_, [&](const Patch& one) { return one.facet == last.element && one.number == last.patch; });
    path.length_m += glm::distance(path.vertices.back(), target);
    path.vertices.push_back(target);
    if (sends(*patch, path)) paths.push_back(std::move(path));
  }
  void add_edges(const GeometricPath& first, const Patch& patch, const dvec3& target,
                 std::vector<GeometricPath>& paths) const {
    const auto& wedges = ways_.model().wedges;
    for (uint32_t edge = 0; edge < wedges.size() && first.interactions.size() < depth_; ++edge) {
      const std::optional<dvec3> point = keller_point(wedges[edge], patch.center, target);
      if (!point) continue;
      GeometricPath path = first;
      path.vertices.push_back(*point);
      path.length_m += glm::distance(patch.center, *point) + glm::distance(*point, target);
      if (!sends(patch, path)) continue;
      path.interactions.push_back({InteractionType::diffraction, edge});
      path.vertices.push_back(target);
      paths.push_back(std::move(path));
    }
  }

  uint32_t depth_;
  Links ways_;
  std::vector<Patch> patches_;
};

/// Powers of a kind: in all, and by bins of 10 ns.
struct Sums {
  double power = 0.0, deviation = 0.0;
  std::map<int64_t, double> bins;
};

inline Sums sums_of(const std::vector<Path>& paths, Kind kind) {
  Sums sums;
  std::vector<Path> of_kind;
  std::vector<double> powers;
  for (const Path& path : paths) {
    if (kind_of(path.interactions, path.from_receiver) != kind) continue;
    of_kind.push_back(path);
    powers.push_back(power_of(path));
    sums.power += powers.back();
    sums.bins[static_cast<int64_t>(path.length_m / delay_bin_m)] += powers.back();
  }
  sums.deviation = drawn_deviation(of_kind, powers);
  return sums;
}

}  // namespace greatx::rf::testing
