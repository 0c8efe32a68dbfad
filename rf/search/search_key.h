// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// The name under which the result of a search is kept.
#pragma once

#include <span>
#include <string>

#include "core/vec.h"
#include "rf/facets/facet_kind.h"
#include "rf/facets/facet_world.h"
#include "rf/search/beam_search.h"

namespace greatx::rf {

/// Everything that decides the result of a search among what stands still, and nothing else, as one SHA-256:
/// the facets of body 0 that waves meet (numbers, shapes, kinds), their wedges, the source's 64-bit
/// coordinates, every option but the number of threads, and the version of the search itself. Bodies that
/// move, the values of materials and the shapes of crowns are not in it. Not for searches among moving
/// bodies.
std::string search_key(const FacetWorld& world, const FacetKinds& kinds, std::span<const scene::Wedge> wedges,
                       const dvec3& source, const BeamSearchOptions& options);

}  // namespace greatx::rf
