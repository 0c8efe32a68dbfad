// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Defines a segment of a path, and what it meets.
#pragma once

#include <cstdint>
#include <vector>

#include "core/vec.h"
#include "shaders/shared/rf.h"

namespace greatx::rf {

/// Describes a segment of a path, and the facets and bodies at its ends, which therefore do not block it.
struct Segment {
  dvec3 a{0.0}, b{0.0};                ///< local coordinates, metres
  uint32_t facet_a = shared::rf_none;  ///< a facet that the path touches at `a`; rf_none: none
  uint32_t facet_b = shared::rf_none;
  /// Body that carries the node at `a` and must not hide it; rf_none: none.
  uint32_t body_a = shared::rf_none;
  uint32_t body_b = shared::rf_none;
  uint32_t other_a = shared::rf_none;  ///< the second face of the wedge at `a`; rf_none: none
  uint32_t other_b = shared::rf_none;
  uint32_t walls = 0;  ///< FacetKind::wall that the segment may pass, at most shared::crossings_max
  /// An earlier segment of the batch with the same ends that may pass at least as many walls. Its answer,
  /// with all its walls, is also the answer of this segment. rf_none: none.
  uint32_t same_as = shared::rf_none;
  /// The leader, a segment of the batch that must be clear. If the leader is blocked, this segment counts as
  /// blocked and is not traced. A leader has no leader itself. rf_none: none.
  uint32_t only_if = shared::rf_none;
};

/// Describes the surfaces that a segment meets.
struct Crossing {
  /// An opaque facet, or more walls than allowed, blocks the segment. The other members then mean nothing.
  bool blocked = false;
  std::vector<uint32_t> walls;  ///< facets passed, each once, ascending by index
  /// Length inside foliage, also where an end is inside, metres. Overlapping volumes add up.
  double foliage_m = 0.0;
  /// fp32 cannot tell; only within CrossingPass.
  bool undecided = false;
  /// The foliage on the segment's line is not a closed volume with its faces outwards: foliage_m is then an
  /// estimate.
  bool foliage_open = false;
};

}  // namespace greatx::rf
