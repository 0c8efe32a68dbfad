// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Cuts facets into patches, each of which scatters as a whole.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "core/vec.h"
#include "rf/facets/facet_kind.h"
#include "scene/description/scene.h"

namespace greatx::rf {

/// Holds a piece of a facet that scatters as a whole.
struct Patch {
  uint32_t facet = 0;
  uint32_t number = 0;  ///< number of the patch on its facet
  dvec3 center{0.0};    ///< in the frame of its body
  double area_m2 = 0.0;
};

/// Cuts every facet whose material scatters into triangles with sides of at most `side_m`, in the order of
/// the facet's triangles. Each cut halves the longest side. Throws UserError if there are more than `most`
/// patches.
std::vector<Patch> scattering_patches(const scene::Scene& scene, const FacetKinds& kinds, double side_m,
                                      size_t most = 10'000'000);

}  // namespace greatx::rf
