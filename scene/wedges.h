// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Edges that diffract: straight edges where two facets meet, or where one ends.
#pragma once

#include <cstdint>
#include <vector>

#include "core/vec.h"
#include "scene/scene.h"

namespace greatx::scene {

inline constexpr uint32_t no_facet = ~0u;

/// A straight edge with its two faces, in its body's frame (body 0: local coordinates). The exterior (the space where
/// waves travel) spans n pi from face 0 to face n, turning about the edge from a to b by the right hand:
/// n = (2 pi - interior angle) / pi, in (0, 2]. n = 2: a half-plane; n = 3/2: the corner of a house; n = 1/2: that of
/// a room.
struct Wedge {
  dvec3 a{0.0}, b{0.0};  ///< ends of the edge
  dvec3 tangent_0{0.0};  ///< unit, in face 0, perpendicular to the edge, pointing away from it
  dvec3 normal_0{
      0.0};  ///< unit, of face 0, pointing into the exterior; tangent_0 x normal_0 = (b - a)/|b - a|
  double n = 2.0;
  uint32_t facet_0 = no_facet;  ///< into Scene::facets; the lower index unless the geometry asks otherwise
  uint32_t facet_n = no_facet;  ///< no_facet: a free edge (n = 2, both faces are sides of facet_0)
  uint32_t body = 0;
};

struct WedgeOptions {
  bool free_edges = false;  ///< edges that one facet alone has: borders of thin plates
  double flat_angle_rad =
      0.035;                   ///< facets that meet this close to flat (|n - 1| pi) make a seam, not a wedge
  double min_length_m = 1e-3;  ///< shorter edges are left out (counted in the scene's notes by the caller)
};

/// Every wedge of the scene, in a canonical order (body, facets, position): a function of the geometry, not of the
/// order of its triangles. Collinear pieces of one edge between the same two facets are one wedge.
std::vector<Wedge> find_wedges(const Scene& scene, const WedgeOptions& options = {});

}  // namespace greatx::scene
