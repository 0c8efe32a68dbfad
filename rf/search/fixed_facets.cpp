// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "rf/search/fixed_facets.h"

#include <algorithm>
#include <utility>

#include "rf/search/beam_search.h"

namespace greatx::rf {
namespace {

constexpr size_t most_answers = 256;

}  // namespace

FixedFacets::FixedFacets(const FacetWorld& world, const FacetKinds& kinds)
    : scene_(std::make_shared<const BeamScene>(world, kinds, std::span<const scene::Wedge>{}, false)),
      index_(world.facet_count(), none) {
  for (uint32_t i = 0; i < scene_->facet_count(); ++i) index_[scene_->facet(i).index] = i;
}

FixedFacets::Facets FixedFacets::find(const dvec3& target, uint32_t walls, uint32_t threads) const {
  BeamSearchOptions options;
  options.max_depth = walls + 1;
  options.max_transmissions = walls;
  options.stop_depth = 1;
  options.threads = threads;
  const BeamSearchResult result = BeamSearch(scene_, options).search(target);
  std::vector<uint32_t> seen;
  for (size_t i = 1; i < result.list.size(); ++i) seen.push_back(index_[result.list.sequence(i).front()]);
  std::sort(seen.begin(), seen.end());
  return std::make_shared<const std::vector<uint32_t>>(std::move(seen));
}

FixedFacets::Facets FixedFacets::seen_from(const dvec3& target, uint32_t walls, uint32_t threads) {
  const auto known = [&]() -> Facets {
    for (const Answer& answer : answers_)
      if (answer.target == target && answer.walls == walls) return answer.facets;
    return nullptr;
  };
  {
    const std::lock_guard lock(mutex_);
    if (Facets facets = known()) return facets;
  }
  Facets facets = find(target, walls, threads);
  const std::lock_guard lock(mutex_);
  if (known()) return facets;
  if (answers_.size() < most_answers)
    answers_.push_back({target, walls, facets});
  else
    answers_[std::exchange(next_, (next_ + 1) % most_answers)] = {target, walls, facets};
  return facets;
}

}  // namespace greatx::rf
