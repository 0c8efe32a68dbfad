// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Finds exactly the facets that a tube sees. The facets that its ray and the rays around it have met are
// clipped to the tube, and nearer facets hide farther ones.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "rf/facets/facet_world.h"
#include "rf/radar/echoes/facet_trees.h"
#include "rf/radar/echoes/polygon.h"
#include "rf/radar/echoes/tube_beam.h"

namespace greatx::rf {

/// Describes a part of a tube in its (u, v) plane, and the facet on which it falls.
struct VisibleCell {
  static constexpr uint32_t nothing = ~0u;
  Polygon part;
  uint32_t facet = nothing;
};

/// Describes the start of a reflected beam. The beam sees only what lies on its side of this facet.
struct BeamStart {
  const PosedFacet* facet = nullptr;  ///< null: the beam starts at the source itself
  uint32_t index = VisibleCell::nothing;
  double side = 1.0;  ///< sign of the facet's distance on the side of the beam
};

/// Holds the working memory of find_visible. The caller keeps it, so that nothing is allocated per tube.
struct VisibleScratch {
  std::vector<uint32_t> pieces;
  std::vector<Polygon> rest;
};

/// Divides `whole` (in the coordinates of the beam) into parts by the facets on which they fall. `facets` is
/// ascending and without repetition. Parts that fall on none of the facets have `nothing`. Of two facets at
/// the same distance the first one counts. Where two facets intersect each other, the centre of their overlap
/// decides which one is nearer. Parts with an area smaller than `smallest` are dropped.
void find_visible(const FacetWorld& world, const FacetTrees& trees, const TubeBeam& beam,
                  const BeamStart& start, const Polygon& whole, std::span<const uint32_t> facets,
                  double smallest, VisibleScratch& scratch, std::vector<VisibleCell>& cells);

}  // namespace greatx::rf
