// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Finds exactly the facets that a tube sees. The facets that its ray and the rays around it have met are
// clipped to the tube, and nearer facets hide farther ones.
#pragma once

#include <array>
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

/// Holds the ranges of u and v of a part of a beam.
struct PartBox {
  dvec2 low{1e300}, high{-1e300};
  explicit PartBox(const Polygon& part) {
    for (uint32_t i = 0; i < part.size(); ++i) add(part[i]);
  }
  PartBox() = default;
  void add(const dvec2& p) { low = glm::min(low, p), high = glm::max(high, p); }
  bool meets(const PartBox& o) const {
    return low.x <= o.high.x && o.low.x <= high.x && low.y <= o.high.y && o.low.y <= high.y;
  }
};

/// Holds the working memory of find_visible. The caller keeps it, so that nothing is allocated per tube.
struct VisibleScratch {
  std::vector<uint32_t> indices;
  std::vector<FacetPiece> pieces;
  std::vector<Polygon> rest;
  std::vector<PartBox> boxes;  ///< [cells]
};

/// Holds the half-spaces of the pyramid around a part of a beam, beyond the facet from which the beam starts.
struct BeamSpaces {
  std::array<KeptSide, 6> sides;
  uint32_t count = 0;
  BeamSpaces(const TubeBeam& beam, const BeamStart& start, const PartBox& box);
  void add(const KeptSide& side) { sides[count++] = side; }
  std::span<const KeptSide> used() const { return std::span(sides).first(count); }
};

/// Returns whether one convex piece of `facet` covers all of `part` and is nowhere behind the plane of
/// `covered`, if one is given.
bool covers(const FacetWorld& world, const FacetTrees& trees, const TubeBeam& beam, const BeamStart& start,
            const Polygon& part, uint32_t facet, VisibleScratch& scratch,
            const PosedFacet* covered = nullptr);

/// Returns the part of a polygon inside a convex outline, or an empty polygon.
Polygon overlap(const Polygon& part, const Polygon& outline);

/// Returns a convex piece as the beam sees it within `within`, or an empty polygon if the beam does not see
/// it.
Polygon seen(std::span<const dvec3> piece, const TubeBeam& beam, const BeamStart& start,
             const PartBox& within);

/// Divides `whole` (in the coordinates of the beam) into parts by the facets on which they fall. `facets` is
/// ascending and without repetition. Parts that fall on none of the facets have `nothing`. Of two facets at
/// the same distance the first one counts. Facets that pass through each other are divided where they meet.
/// Parts with an area smaller than `smallest` are dropped.
void find_visible(const FacetWorld& world, const FacetTrees& trees, const TubeBeam& beam,
                  const BeamStart& start, const Polygon& whole, std::span<const uint32_t> facets,
                  double smallest, VisibleScratch& scratch, std::vector<VisibleCell>& cells);
/// The same for the given pieces of facets, which are ascending. All of `whole` falls at first on the facet
/// `at_first`, which covers it; VisibleCell::nothing if no facet does.
void find_visible(const FacetWorld& world, const FacetTrees& trees, const TubeBeam& beam,
                  const BeamStart& start, const Polygon& whole, uint32_t at_first,
                  std::span<const FacetPiece> pieces, double smallest, VisibleScratch& scratch,
                  std::vector<VisibleCell>& cells);
/// Returns the parts that find_visible leaves on `own` (not `nothing`), in the same order and with the same
/// bits. It drops what is hidden, and ends once nothing is left.
void find_unhidden(const FacetWorld& world, const FacetTrees& trees, const TubeBeam& beam,
                   const BeamStart& start, const Polygon& whole, uint32_t own,
                   std::span<const FacetPiece> pieces, double smallest, VisibleScratch& scratch,
                   std::vector<Polygon>& parts);

}  // namespace greatx::rf
