// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "rf/search/fixed_facets.h"

#include <algorithm>

#include "rf/search/beam_search.h"

namespace greatx::rf {

FixedFacets::FixedFacets(const FacetWorld& world, const FacetKinds& kinds)
    : scene_(std::make_shared<const BeamScene>(world, kinds, std::span<const scene::Wedge>{}, false)) {}

std::vector<uint32_t> FixedFacets::find(const dvec3& target, uint32_t walls, uint32_t threads) const {
  BeamSearchOptions options;
  options.max_depth = walls + 1;
  options.max_transmissions = walls;
  options.stop_depth = 1;
  options.threads = threads;
  const BeamSearchResult result = BeamSearch(scene_, options).search(target);
  std::vector<uint32_t> seen;
  for (size_t i = 1; i < result.list.size(); ++i)
    seen.push_back(scene_->index_of(result.list.sequence(i).front()));
  std::sort(seen.begin(), seen.end());
  return seen;
}

FixedFacets::Facets FixedFacets::seen_from(const dvec3& target, uint32_t walls, uint32_t threads) {
  return answers_.get({target, walls}, true, [&] { return find(target, walls, threads); });
}

}  // namespace greatx::rf
