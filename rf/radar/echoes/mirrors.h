// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Finds the targets that a radar sees over mirrors: which facets act as mirrors for which targets, and where
// the images of the targets are. Tubes are made as fine at the images as on the targets themselves.
#pragma once

#include <algorithm>
#include <cstdint>
#include <span>
#include <vector>

#include "rf/facets/facet_world.h"
#include "rf/radar/echoes/echo_tracer.h"
#include "rf/radar/echoes/facet_trees.h"
#include "rf/radar/echoes/ray_grid.h"
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

/// Holds the facets of a scene that reflect, sorted once by their extents.
class MirrorFinder {
 public:
  MirrorFinder(const scene::Scene& scene, const FacetWorld& world, const RadioSurfaces& surfaces);

  /// Returns the images of `targets` of which a radar at `radar` sees at least a part. Each image is seen
  /// over one mirror that is at least half as wide as the target. At least one of nine points of the target's
  /// box is visible over the mirror. The images are in the order of the targets, then in that of the mirrors'
  /// widths. The facets of `own_body` are ignored; 0: none.
  std::vector<TargetImage> find(std::span<const TargetBox> targets, const FacetWorld& world,
                                const FacetTrees& trees, const EchoTracer& tracer, const dvec3& radar,
                                uint32_t own_body) const;

 private:
  struct Mirror {
    uint32_t facet = 0;
    double extent_m = 0.0;
  };
  const scene::Scene& scene_;
  std::vector<Mirror> mirrors_;  ///< sorted by extent, the widest first
};

}  // namespace greatx::rf
