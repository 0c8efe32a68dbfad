// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Looks for leaks by rays from within solids. This is a second test beside that of the edges
// (scene/check/openings.h), which knows nothing of edges.
#pragma once

#include "scene/check/openings.h"

namespace greatx::scene::check {

struct RayCount {
  uint64_t rays = 0, out = 0;
};

/// From eight points within each closed or nearly closed part, `options.rays` rays go in directions that are
/// uniform on the sphere. A point lies halfway between a random point of the surface and the next surface
/// behind it. A closed part meets its own triangles; a part whose openings others close, all triangles of its
/// group; a part with a hidden opening is left out. A ray that meets nothing is a leak. A hole that takes the
/// share p of the directions is missed with the probability (1 - p)^rays. Adds
///   ray_leak        parts with open edges of which rays come out; the size is the share of the rays
///   overlaps_itself parts from whose inside rays meet a front, once all their triangles look outwards, or
///                   that have no open edge and yet let a ray out: the part reaches into itself (a doubt)
/// The random numbers depend on the seed and the part alone.
RayCount find_leaks_by_rays(const Soup& soup, const Topology& topology, const Closing& closing,
                            const SoupTree& tree, const CheckOptions& options, FaultList& faults);

}  // namespace greatx::scene::check
