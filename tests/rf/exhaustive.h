// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Solves the paths of a single pair over every sequence of facets, for small scenes.
#pragma once

#include <cstdint>
#include <vector>

#include "rf/geometry/geometry.h"

namespace greatx::rf::testing {

/// Returns every sequence of `facet_count` facets up to `max_depth` without immediate repetition, with the
/// line of sight, in canonical order.
inline CandidateList exhaustive_candidates(uint32_t facet_count, uint32_t max_depth) {
  CandidateList list;
  list.add({});
  size_t first = 0, last = 1;  // the sequences of the depth before
  std::vector<uint32_t> sequence;
  for (uint32_t depth = 1; depth <= max_depth; ++depth) {
    for (size_t parent = first; parent < last; ++parent) {
      const auto prefix = list.sequence(parent);
      sequence.assign(prefix.begin(), prefix.end());
      for (uint32_t facet = 0; facet < facet_count; ++facet) {
        if (!sequence.empty() && sequence.back() == facet) continue;
        sequence.push_back(facet);
        list.add(sequence);
        sequence.pop_back();
      }
    }
    first = last;
    last = list.size();
  }
  return list;
}

/// Builds the tree of a single pair, solves it and discards it.
inline std::vector<GeometricPath> solve_paths(const FacetWorld& world, const dvec3& transmitter,
                                              const dvec3& receiver, const CandidateList& candidates) {
  return ImageTree(world, transmitter, candidates).solve(receiver);
}

}  // namespace greatx::rf::testing
