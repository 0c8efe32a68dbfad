// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Holds the facets at rest as the searches between moving ends see them. Searches from several sources to the
// same targets share one object, so that what a target sees is found once.
#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "core/vec.h"
#include "rf/search/beam_scene.h"
#include "rf/search/kept_answers.h"

namespace greatx::rf {

class FixedFacets {
 public:
  FixedFacets(const FacetWorld& world, const FacetKinds& kinds);

  const std::shared_ptr<const BeamScene>& scene() const { return scene_; }

  using Facets = std::shared_ptr<const std::vector<uint32_t>>;
  /// Returns the facets, ascending in scene(), that `target` may see if nothing moves, behind at most `walls`
  /// walls. Many threads may call this. The last answers are kept.
  Facets seen_from(const dvec3& target, uint32_t walls, uint32_t threads);

 private:
  struct Question {
    dvec3 target{0.0};
    uint32_t walls = 0;
    bool operator==(const Question&) const = default;
  };
  static constexpr size_t most_answers = 256;
  std::vector<uint32_t> find(const dvec3& target, uint32_t walls, uint32_t threads) const;

  std::shared_ptr<const BeamScene> scene_;
  KeptAnswers<Question, std::vector<uint32_t>> answers_{most_answers};
};

}  // namespace greatx::rf
