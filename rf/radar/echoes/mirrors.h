// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Finds the targets that a radar sees over mirrors: which facets act as mirrors for which targets.
#pragma once

#include <algorithm>
#include <compare>
#include <cstdint>
#include <span>
#include <vector>

#include "rf/facets/facet_world.h"
#include "rf/radar/echoes/echo_tracer.h"
#include "rf/radar/echoes/facet_trees.h"
#include "rf/surface/surfaces.h"
#include "scene/description/scene.h"

namespace greatx::rf {

/// Returns whether `mirror` is more than three times as wide as `facet`. The wave of `facet` then spreads
/// over a part of `mirror` and does not fill it: the currents are taken on the small facet, and the wide one
/// acts as a mirror.
inline bool mirrors(const FacetWorld& world, uint32_t mirror, uint32_t facet) {
  constexpr double ratio = 3.0;  // ratio of the extents
  const auto extent = [&](uint32_t index) {
    const PosedFacet& posed = world.facet(index);
    return std::max(posed.max_u - posed.min_u, posed.max_v - posed.min_v);
  };
  return ratio * extent(facet) < extent(mirror);
}

/// Describes a possible target: a box at a pose.
struct TargetBox {
  scene::Bounds bounds;  ///< in the frame of `pose`
  Pose pose;             ///< in local coordinates
  uint32_t instance = 0, body = 0;
};

/// Describes a facet of a target that is seen over a mirror, or parts of it.
struct MirroredFacet {
  uint32_t mirror = 0, facet = 0;
  auto operator<=>(const MirroredFacet&) const = default;
};

/// Holds the facets of a scene that reflect, sorted once by their extents.
class MirrorFinder {
 public:
  MirrorFinder(const scene::Scene& scene, const FacetWorld& world, const RadioSurfaces& surfaces);

  /// Returns the facets of `targets` and the mirrors over which a radar at `radar` may see them, ascending.
  /// The mirror is at least half as wide as the target. At least one of nine points of the target's box is
  /// visible over it. The facets of `own_body` are ignored; 0: none. Uses `threads` threads.
  std::vector<MirroredFacet> find(std::span<const TargetBox> targets, const FacetWorld& world,
                                  const FacetTrees& trees, const EchoTracer& tracer, const dvec3& radar,
                                  uint32_t own_body, uint32_t threads) const;

 private:
  /// Holds what a search looks with.
  struct Search {
    const FacetWorld& world;
    const FacetTrees& trees;
    const EchoTracer& tracer;
    dvec3 radar;
    uint32_t own_body;
    EchoTracer::View view;
  };
  struct Mirror {
    uint32_t facet = 0;
    double extent_m = 0.0;
  };
  /// Appends what is seen of one target, perhaps with repetition.
  void find(const TargetBox& box, const Search& search, std::vector<MirroredFacet>& found) const;
  void add_facets(const TargetBox& target, uint32_t mirror, const FacetWorld& world,
                  std::vector<MirroredFacet>& found) const;

  const scene::Scene& scene_;
  std::vector<Mirror> mirrors_;        ///< sorted by extent, the widest first
  std::vector<uint32_t> first_facet_;  ///< [bodies + 1]; the facets of a body are a range
};

}  // namespace greatx::rf
