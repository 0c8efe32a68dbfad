// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Provides small scenes that are hard to search, and checks a search of them against the reference.
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
  FacetKinds kinds;  ///< empty: all facets are opaque
  dvec3 source{0.0};
  dvec3 low{-10.0, -10.0, 0.2}, high{10.0, 10.0, 8.0};  ///< random receivers lie in this box
  std::vector<dvec3> receivers;                         ///< further receivers
  uint32_t drawn = 40;
  uint32_t depth = 3, walls = 0;

  const scene::Scene& scene() const { return hand.scene; }
  FacetKinds facet_kinds() const;
  /// Returns the given receivers and those drawn from a seed.
  std::vector<dvec3> points() const;
  BeamSearchOptions options() const;
  /// Adds a box with its normals outwards, in the order two x faces, two y faces, two z faces.
  void box(const dvec3& low, const dvec3& high);
};

/// Returns the paths of `list` after all further steps, [receivers], in canonical order: line of sight,
/// reflections and passed walls. The occluders of the reference find the crossings on the host.
std::vector<std::vector<GeometricPath>> solve(const SearchScene& scene, const CandidateList& list);

/// Expects that the search finds every path of the reference once and no other path, with the default
/// clearance and with zero clearance. Expects equal results with one and two threads, and with and without
/// windows. Returns the number of the reference's paths by number of interactions.
std::vector<size_t> expect_perfect(const SearchScene& scene, const std::string& name);

}  // namespace greatx::rf::testing
