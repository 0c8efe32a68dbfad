// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Edges that diffract: straight edges where two facets meet, or where one ends.
#pragma once

#include <cstdint>
#include <vector>

#include "core/vec.h"
#include "scene/description/scene.h"

namespace greatx::scene {

inline constexpr uint32_t no_facet = ~0u;

/// A straight edge with its two faces, in its body's frame (body 0: local coordinates). The exterior (where waves travel)
/// spans n pi from face 0 to face n, turning about the edge from a to b by the right hand: n = (2 pi - interior angle)/pi.
/// Facets reflect on both sides, so the exterior is geometry, not winding: whichever side is wider than pi. Hence n is in
/// (1, 2]: 3/2 for the corner of a house, seen from outside, and of a room's pillar; 2 for a half-plane. The narrow side
/// (the corner of a room) does not diffract: there the waves reflected by both faces join without a gap.
struct Wedge {
  dvec3 a{0.0}, b{0.0};  ///< ends of the edge
  dvec3 tangent_0{0.0};  ///< unit, in face 0, perpendicular to the edge, pointing away from it
  dvec3 normal_0{0.0};   ///< unit, perpendicular to the edge and to tangent_0, pointing into the exterior:
                         ///< tangent_0 x normal_0 = (b - a)/|b - a|
  double n = 2.0;
  uint32_t facet_0 = no_facet;  ///< into Scene::facets; the lower index of the two
  uint32_t facet_n =
      no_facet;  ///< no_facet: a free edge (n = 2, both faces are sides of facet_0, face 0 its front)
  uint32_t body = 0;
};

struct WedgeOptions {
  bool free_edges = false;  ///< edges that one facet alone has: borders of thin plates
  double flat_angle_rad =
      0.035;                   ///< facets that meet this close to flat ((n - 1) pi) make a seam, not a wedge
  double min_length_m = 1e-3;  ///< shorter edges are left out, and counted
  double weld_distance_m =
      1e-4;  ///< what is this close together is in one place (as for merging, BuildOptions)
};

/// Every wedge of the scene, in a canonical order (body, facets, position). Decided edge by edge from what lies around it
/// in the same body:
/// - a facet that ends at the edge goes off in one direction, one that contains the edge in two: so a box that stands on
///   a ground, with or without common vertices, has no wedge along its foot, nor a storey on a wider one;
/// - between neighbouring directions at most one gap is wider than pi: the wedge is there, with the two facets beside it,
///   whatever number meet. None: no wedge (roofs of two houses that touch, corner to corner);
/// - of facets in the same place (duplicates, two sides of one sheet) the lowest index counts;
/// - one direction alone: a free edge.
/// Edges need no common vertices: pieces, however each side is split, are compared where they overlap, and joined again
/// into one wedge per straight run between the same two facets. Facets in different bodies make no wedge. `too_short`: how many were left out for
/// their length.
std::vector<Wedge> find_wedges(const Scene& scene, const WedgeOptions& options = {},
                               uint64_t* too_short = nullptr);

}  // namespace greatx::scene
