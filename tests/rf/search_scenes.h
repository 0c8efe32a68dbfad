// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Small scenes that are hard to search, and what has to be found in them.
#pragma once

#include <string>
#include <vector>

#include "rf/facets/facet_kind.h"
#include "rf/geometry/path.h"
#include "rf/search/beam_search.h"
#include "tests/rf/scenes.h"

namespace greatx::rf::testing {

struct SearchScene {
  HandScene hand;
  FacetKinds kinds;  ///< empty: all opaque
  dvec3 source{0.0};
  dvec3 low{-10.0, -10.0, 0.2}, high{10.0, 10.0, 8.0};  ///< receivers are drawn in this box
  std::vector<dvec3> receivers;                         ///< and these as well
  uint32_t drawn = 40;
  uint32_t depth = 3, walls = 0;

  const scene::Scene& scene() const { return hand.scene; }
  FacetKinds facet_kinds() const;
  /// Those that are given and those that are drawn, from a seed.
  std::vector<dvec3> points() const;
  BeamSearchOptions options() const;
  /// Faces outwards: two x, two y, two z.
  void box(const dvec3& low, const dvec3& high);
};

/// What a search and all that follows find: [receivers], line of sight, reflections and walls passed;
/// canonical order. Crossings by the reference's occluders, on the host.
std::vector<std::vector<GeometricPath>> solve(const SearchScene& scene, const CandidateList& list);

/// The default options and no clearance at all: every path of the reference, none twice and no other, whether
/// bounded by windows or not; one and two threads the same. Returns the reference's paths by number of
/// interactions.
std::vector<size_t> expect_perfect(const SearchScene& scene, const std::string& name);

}  // namespace greatx::rf::testing
