// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Targets that a radar sees over mirrors: which facets are mirrors to which, and where the images of targets
// are, so that tubes are as fine there as on the targets themselves.
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

/// Whether `mirror` is so much wider than `facet` that waves of the one spread over it rather than fill it:
/// currents are taken on the small one and the wide one mirrors.
inline bool mirrors(const FacetWorld& world, uint32_t mirror, uint32_t facet) {
  constexpr double ratio = 3.0;  // of extents
  const auto extent = [&](uint32_t index) {
    const PosedFacet& posed = world.facet(index);
    return std::max(posed.max_u - posed.min_u, posed.max_v - posed.min_v);
  };
  return ratio * extent(facet) < extent(mirror);
}

/// All of a scene, sorted once.
class MirrorFinder {
 public:
  MirrorFinder(const scene::Scene& scene, const FacetWorld& world, const RadioSurfaces& surfaces);

  /// The images of `targets` that a radar at `radar` sees, if only in part: each over one mirror that is at
  /// least half as wide as the target, with nothing between the three that hides all of nine points of the
  /// target's box. In the order of the targets, then of the mirrors' widths. `own_body`: that is not seen.
  std::vector<TargetImage> find(std::span<const TargetBox> targets, const FacetWorld& world,
                                const FacetTrees& trees, const EchoTracer& tracer, const dvec3& radar,
                                uint32_t own_body) const;

 private:
  struct Mirror {
    uint32_t facet = 0;
    double extent_m = 0.0;
  };
  const scene::Scene& scene_;
  std::vector<Mirror> mirrors_;  ///< by extent, the widest first
};

}  // namespace greatx::rf
