// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// The part that a facet plays in the geometry of radio paths. It follows from the facet's material and from
// the effects that are on, and not from a channel's own carrier: facet_kinds() of rf/paths/radio_model.h
// gives every channel of a run an equal list. The searches, the midpoints and the crossings read it. The
// field along a path does not.
#pragma once

#include <cstdint>
#include <vector>

namespace greatx::rf {

enum class FacetKind : uint8_t {
  /// It reflects on both sides and nothing passes: a half-space, a wall that takes too much, or transmission
  /// is off.
  opaque = 0,
  /// It reflects and lets waves pass: a slab or several layers with vacuum behind, and transmission is on.
  wall = 1,
  foliage = 2,  ///< the boundary of a volume that attenuates; it never reflects and never blocks
  absent = 3,   ///< as if it were not there: foliage while that effect is off
};

/// [facets of the scene]
using FacetKinds = std::vector<FacetKind>;

}  // namespace greatx::rf
