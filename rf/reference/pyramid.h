// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// The reference's only bound on directions: what an image sees through the facet that it was mirrored at.
#pragma once

#include <vector>

#include "core/vec.h"
#include "rf/facets/facet_world.h"
#include "rf/reference/box_tree.h"
#include "scene/description/scene.h"

namespace greatx::rf::reference {

/// A facet as the bound takes it: the corners of the convex hull of its triangles, in its plane.
struct Hull {
  std::vector<dvec3> corners;  ///< in order around the hull
  dvec3 center{0.0};           ///< inside
  scene::Bounds box;
};
/// Of `corners` (any number, anywhere near the plane of `facet`).
Hull convex_hull(const PosedFacet& facet, const std::vector<dvec3>& corners);

/// Half-spaces whose intersection holds every point that a straight line from `image` reaches through the
/// facet, beyond it. `side`: +1 if the paths are on the side of the facet's normal, -1 otherwise; the image
/// is on the other. Sides of the pyramid that roundings could turn are left out.
void pyramid(const dvec3& image, const PosedFacet& facet, const Hull& hull, double side,
             std::vector<HalfSpace>& half_spaces);

/// A half-space as the mirror of a facet shows it.
HalfSpace mirrored(const HalfSpace& half, const PosedFacet& facet);

/// Whether some corner lies in each of the half-spaces: false only if all of the hull is outside of one.
bool may_meet(const Hull& hull, const std::vector<HalfSpace>& half_spaces);

}  // namespace greatx::rf::reference
