// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// What a facet is to the geometry of radio paths. Decided once per channel from the materials and the effects that are
// on; search, crossings and field all read the same list.
#pragma once

#include <cstdint>
#include <vector>

namespace greatx::rf {

enum class FacetKind : uint8_t {
  opaque = 0,  ///< reflects on both sides, nothing passes: a half-space, metal, or transmission is off
  wall =
      1,  ///< reflects and lets waves pass: a slab or several layers with vacuum behind, transmission is on
  foliage = 2,  ///< boundary of an attenuating volume: never reflects, never blocks
  absent = 3,   ///< as if it were not there: foliage while that effect is off
};

/// [facets of the scene]
using FacetKinds = std::vector<FacetKind>;

}  // namespace greatx::rf
