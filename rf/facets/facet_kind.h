// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Defines the part that a facet plays in the geometry of radio paths. The kind depends on the facet's
// material and on the effects that are on, and not on a channel's own carrier: facet_kinds() of
// rf/paths/radio_model.h gives every channel of a run the same list. The searches, the midpoints and the
// crossings read this list. The field along a path does not.
#pragma once

#include <cstdint>
#include <vector>

namespace greatx::rf {

enum class FacetKind : uint8_t {
  /// Reflects on both sides and lets nothing pass: a half-space, a wall with too much loss, or any wall while
  /// transmission is off.
  opaque = 0,
  /// Reflects and lets waves pass, while transmission is on: a slab or several layers with vacuum behind, or
  /// any wall with windows, be it a half-space.
  wall = 1,
  foliage = 2,  ///< boundary of a volume that attenuates; it never reflects and never blocks
  absent = 3,   ///< has no effect: foliage without losses, or all foliage while that effect is off
};

/// Kinds of all facets, [facets of the scene].
using FacetKinds = std::vector<FacetKind>;

}  // namespace greatx::rf
