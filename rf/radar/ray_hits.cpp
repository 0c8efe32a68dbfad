// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "rf/radar/ray_hits.h"

#include <algorithm>

#include "core/error.h"
#include "core/parallel.h"
#include "shaders/shared/radar.h"

namespace greatx::rf {

static_assert(RayHits::nothing == shared::radar_none);

RayHits::RayHits(std::span<const uint32_t> words, uint32_t tubes)
    : words_(words.begin(), words.end()),
      tubes_(tubes),
      bounces_(tubes == 0 ? 0 : static_cast<uint32_t>(words.size() / tubes)) {
  GREATX_CHECK(words.size() == size_t{tubes_} * bounces_, "{} words of {} tubes", words.size(), tubes);
}

uint32_t RayHits::facet(uint32_t word) { return word == nothing ? nothing : word & shared::radar_facet_mask; }

bool RayHits::sees_receiver(uint32_t word) {
  return word != nothing && (word & shared::radar_sees_receiver) != 0;
}

bool RayHits::seen_about(const RayGrid& grid, uint32_t tube, uint32_t wanted) const {
  if (facet(word(tube, 0)) == wanted) return true;
  const auto meets = [&](uint32_t other) {
    return other != RayGrid::outside && facet(word(other, 0)) == wanted;
  };
  const std::array<uint32_t, 8> ring = grid.neighbours(tube);
  return std::any_of(ring.begin(), ring.end(), meets);
}

void RayHits::find_seen(const RayGrid& grid, const FacetWorld& world, const dvec3& radar, uint32_t threads) {
  constexpr uint32_t chunk = 512;
  if (bounces_ < 2) return;
  parallel_for((tubes_ + chunk - 1) / chunk, threads, [&](size_t part) {
    const uint32_t first = static_cast<uint32_t>(part) * chunk, last = std::min(tubes_, first + chunk);
    for (uint32_t tube = first; tube < last; ++tube) {
      dvec3 at = radar, direction(0.0);
      for (uint32_t bounce = 0; bounce < bounces_; ++bounce) {
        uint32_t& own = words_[size_t{bounce} * tubes_ + tube];
        if (!met(own) || (bounce == 0 && (bounces_ == 1 || !met(word(tube, 1))))) break;
        if (bounce == 0) direction = grid.axis(tube);
        const PosedFacet& posed = world.facet(facet(own));
        const double towards = glm::dot(posed.normal, direction);
        at -= posed.distance(at) / towards * direction;
        direction -= 2.0 * towards * posed.normal;
        if (bounce == 0) continue;
        const uint32_t there = grid.tube_at(at - radar);
        own = facet(own);
        if (there != RayGrid::outside && seen_about(grid, there, own)) own |= shared::radar_sees_receiver;
      }
    }
  });
}

}  // namespace greatx::rf
