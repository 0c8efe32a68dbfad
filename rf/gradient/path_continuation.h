// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Continues a path to other places of its ends: the same sequence of interactions, solved again.
#pragma once

#include <span>

#include "rf/facets/facet_world.h"
#include "rf/geometry/path.h"
#include "scene/description/wedges.h"

namespace greatx::rf {

/// Tells what became of a path.
enum class Continuation : uint8_t {
  exists,  ///< every point is on its facet or edge
  /// A reflection, a passage through a wall or a diffraction lies beyond its facet or edge, on its plane or
  /// line. The path is not one of the scene, but its field is a smooth continuation.
  beyond,
  lost,  ///< no such path, not even with endless facets: an end has gone behind a mirror
};

struct ContinuedPath {
  GeometricPath path;  ///< without meaning if it is lost
  Continuation state = Continuation::exists;
};

/// Solves the sequence of `path` between other ends, exactly: reflections by images, a diffraction by
/// Keller's point between images, two of them by the least length. Scattering patches and ends of edges stay
/// where they are. Walls are passed where the new segments meet their planes. The area of patches, the length
/// in foliage, and which edges are in other paths stay as they are. EdgeSides and KellerSide are left to the
/// angles, since the path may have gone away from its boundary. With the ends that it has, the path is
/// returned as it is. `world`: the facets for which the path was solved; `wedges`: those of the field model.
///
/// Whether other facets block the path is not looked at.
ContinuedPath continued_path(const GeometricPath& path, const FacetWorld& world,
                             std::span<const scene::Wedge> wedges, const dvec3& transmitter,
                             const dvec3& receiver);

}  // namespace greatx::rf
