// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Computes how the vertices of a path move with its ends.
//
// Ends of the path, scattering patches and ends of edges are anchors: they are given. Between two anchors the
// path is the shortest one over its edges, after its reflections are unfolded. In this order follow
// - Keller's points, of one edge in closed form by unfolding (rf/edges/diffraction.h), and of two by the
//   theorem of implicit functions: the length is stationary in both places, so that H dz = -dg for the slope
//   g of the length and its second derivatives H (as Newton's step in rf/edges/keller_points.cpp);
// - the reflection points between two bends, where rays from the images meet the facets, in closed form as in
//   rf/geometry/geometry.cpp. Hence a run of no length, in a corner, is no special case;
// - the points in walls, on the straight line between their neighbours.
// The values stay those of the path; only slopes are computed.
#pragma once

#include <span>
#include <vector>

#include "core/dual.h"
#include "rf/facets/facet_world.h"
#include "rf/geometry/path.h"
#include "scene/description/wedges.h"

namespace greatx::rf {

struct DualVertices {
  std::vector<Vec3Of<Dual>> vertices;  ///< as GeometricPath::vertices
  Dual length_m;                       ///< as GeometricPath::length_m
};

/// `transmitter` and `receiver` are the ends with their slopes. Throws ContractError for a path with
/// interactions that path_field() does not take.
DualVertices dual_vertices(const GeometricPath& path, const FacetWorld& world,
                           std::span<const scene::Wedge> wedges, const Vec3Of<Dual>& transmitter,
                           const Vec3Of<Dual>& receiver);

}  // namespace greatx::rf
