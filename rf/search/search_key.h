// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Computes the name under which the result of a search is kept.
#pragma once

#include <span>
#include <string>

#include "core/vec.h"
#include "rf/facets/facet_kind.h"
#include "rf/facets/facet_world.h"
#include "rf/search/beam_search.h"

namespace greatx::rf {

/// Returns a SHA-256 of everything that decides the result of a search in the static world, and of nothing
/// else: the facets of body 0 that waves meet (numbers, shapes, kinds), their wedges, the 64-bit coordinates
/// of the source, every option except the number of threads, and the version of the search. Moving bodies,
/// the values of materials and the shapes of crowns are not included. The key is not valid for searches with
/// moving bodies.
std::string search_key(const FacetWorld& world, const FacetKinds& kinds, std::span<const scene::Wedge> wedges,
                       const dvec3& source, const BeamSearchOptions& options);

}  // namespace greatx::rf
