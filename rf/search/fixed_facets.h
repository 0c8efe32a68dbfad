// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Holds the facets at rest as the searches between moving ends see them. Searches from several sources to the
// same targets share one object, so that what a target sees is found once.
#pragma once

#include <cstdint>
#include <memory>
#include <mutex>
#include <vector>

#include "core/vec.h"
#include "rf/search/beam_scene.h"

namespace greatx::rf {

class FixedFacets {
 public:
  FixedFacets(const FacetWorld& world, const FacetKinds& kinds);

  static constexpr uint32_t none = ~0u;
  const std::shared_ptr<const BeamScene>& scene() const { return scene_; }
  /// Returns the index in scene() of a facet of the world; none if it moves.
  uint32_t index_of(uint32_t facet) const { return index_[facet]; }

  using Facets = std::shared_ptr<const std::vector<uint32_t>>;
  /// Returns the facets, ascending in scene(), that `target` may see if nothing moves, behind at most `walls`
  /// walls. Many threads may call this. The last answers are kept.
  Facets seen_from(const dvec3& target, uint32_t walls, uint32_t threads);

 private:
  struct Answer {
    dvec3 target{0.0};
    uint32_t walls = 0;
    Facets facets;
  };
  Facets find(const dvec3& target, uint32_t walls, uint32_t threads) const;

  std::shared_ptr<const BeamScene> scene_;
  std::vector<uint32_t> index_;  ///< [facets of the world]
  std::mutex mutex_;
  std::vector<Answer> answers_;  ///< a ring
  size_t next_ = 0;
};

}  // namespace greatx::rf
