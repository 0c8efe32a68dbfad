// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "rf/radar/echoes/ray_hits.h"

#include <algorithm>

#include "core/error.h"
#include "core/parallel.h"
#include "rf/radar/echoes/mirrors.h"
#include "rf/radar/echoes/tube_beam.h"
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

bool RayHits::sees_over(uint32_t word) { return word != nothing && (word & shared::radar_sees_over) != 0; }

bool RayHits::seen_about(const RayGrid& grid, uint32_t tube, uint32_t wanted, uint32_t before) const {
  const auto meets = [&](uint32_t other) {
    if (other == RayGrid::outside) return false;
    if (before == nothing) return facet(word(other, 0)) == wanted;
    return facet(word(other, 0)) == before && facet(word(other, 1)) == wanted;
  };
  if (meets(tube)) return true;
  const std::array<uint32_t, 8> ring = grid.neighbours(tube);
  return std::any_of(ring.begin(), ring.end(), meets);
}

void RayHits::find_seen(const RayGrid& grid, const FacetWorld& world, const dvec3& radar,
                        uint32_t max_bounces, uint32_t threads) {
  constexpr uint32_t chunk = 512;
  if (bounces_ < 2) return;
  // The new words are kept apart, because other tubes still read the old ones.
  std::vector<uint32_t> words(words_.begin() + tubes_, words_.end());
  parallel_for((tubes_ + chunk - 1) / chunk, threads, [&](size_t part) {
    const uint32_t first = static_cast<uint32_t>(part) * chunk, last = std::min(tubes_, first + chunk);
    for (uint32_t tube = first; tube < last; ++tube) {
      const uint32_t mirror = facet(word(tube, 0));
      if (mirror == nothing || !met(word(tube, 1))) continue;
      const bool over = mirrors(world, mirror, facet(word(tube, 1)));
      dvec3 at = radar, direction = grid.axis(tube);
      for (uint32_t bounce = 0; bounce < bounces_; ++bounce) {
        const uint32_t own = facet(word(tube, bounce));
        if (own == nothing) break;
        if (bounce >= max_bounces && !over) {
          for (; bounce < bounces_; ++bounce) words[size_t{bounce - 1} * tubes_ + tube] = nothing;
          break;
        }
        const PosedFacet& posed = world.facet(own);
        const double towards = glm::dot(posed.normal, direction);
        at -= posed.distance(at) / towards * direction;
        direction -= 2.0 * towards * posed.normal;
        if (bounce == 0) continue;
        uint32_t& seen = words[size_t{bounce - 1} * tubes_ + tube];
        seen = own;
        if (bounce == 1 && over) {
          if (max_bounces >= mirror_bounces) seen |= shared::radar_sees_over;
          continue;
        }
        const auto about = [&](const dvec3& point, uint32_t before) {
          const uint32_t there = grid.tube_at(point - radar);
          return there != RayGrid::outside && seen_about(grid, there, own, before);
        };
        if (about(at, nothing)) seen |= shared::radar_sees_receiver;
        if (max_bounces < mirror_bounces || bounce < 2 || !mirrors(world, mirror, own)) continue;
        const PosedFacet& plane = world.facet(mirror);
        if (about(mirrored(plane, at), mirror)) seen |= shared::radar_sees_over;
      }
    }
  });
  std::copy(words.begin(), words.end(), words_.begin() + tubes_);
}

}  // namespace greatx::rf
