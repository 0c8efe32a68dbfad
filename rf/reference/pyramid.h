// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Computes the reference's only bound on directions: the region that an image sees through the facet that
// mirrored it.
#pragma once

#include <vector>

#include "core/vec.h"
#include "rf/facets/facet_world.h"
#include "rf/reference/box_tree.h"
#include "scene/description/scene.h"

namespace greatx::rf::reference {

/// Holds a facet as the bound uses it: the corners of the convex hull of its triangles, in its plane.
struct Hull {
  std::vector<dvec3> corners;  ///< in order around the hull
  dvec3 center{0.0};           ///< mean of the corners, inside the hull
  scene::Bounds box;
};
/// Returns the hull of `corners` (any number, anywhere near the plane of `facet`).
Hull convex_hull(const PosedFacet& facet, const std::vector<dvec3>& corners);

/// Sets half-spaces whose intersection holds every point beyond the facet that a straight line from `image`
/// reaches through the facet. `side` is +1 if the paths are on the side of the facet's normal, else -1; the
/// image is on the other side. Sides of the pyramid that roundings could turn are left out.
void pyramid(const dvec3& image, const PosedFacet& facet, const Hull& hull, double side,
             std::vector<HalfSpace>& half_spaces);

/// Returns the mirror image of a half-space in a facet.
HalfSpace mirrored(const HalfSpace& half, const PosedFacet& facet);

/// Tells whether each half-space contains a corner. Returns false only if the whole hull is outside one of
/// them.
bool may_meet(const Hull& hull, const std::vector<HalfSpace>& half_spaces);

}  // namespace greatx::rf::reference
