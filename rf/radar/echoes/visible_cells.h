// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// What a tube sees, exactly: the facets that its ray and those around it have met, each clipped to the tube,
// the nearer in front of the farther.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "rf/facets/facet_world.h"
#include "rf/radar/echoes/facet_trees.h"
#include "rf/radar/echoes/polygon.h"
#include "rf/radar/echoes/tube_beam.h"

namespace greatx::rf {

/// A part of a tube in its (u, v) plane, and the facet that it falls on.
struct VisibleCell {
  static constexpr uint32_t nothing = ~0u;
  Polygon part;
  uint32_t facet = nothing;
};

/// Where a reflected beam begins: it sees what lies on its side of this facet alone.
struct BeamStart {
  const PosedFacet* facet = nullptr;  ///< none: at the source itself
  uint32_t index = VisibleCell::nothing;
  double side = 1.0;  ///< sign of the facet's distance on the beam's side
};

/// What find_visible works with; kept by the caller so that nothing is allocated tube by tube.
struct VisibleScratch {
  std::vector<uint32_t> pieces;
  std::vector<Polygon> rest;
};

/// Parts of `whole` (in the beam's coordinates) by what they fall on; what falls on none of `facets`
/// (ascending, each once) is left as `nothing`. Of two facets at the same distance the first one counts.
/// Facets that cut through each other are told apart at the centre of where they overlap.
/// `smallest`: parts of less area than this are dropped.
void find_visible(const FacetWorld& world, const FacetTrees& trees, const TubeBeam& beam,
                  const BeamStart& start, const Polygon& whole, std::span<const uint32_t> facets,
                  double smallest, VisibleScratch& scratch, std::vector<VisibleCell>& cells);

}  // namespace greatx::rf
