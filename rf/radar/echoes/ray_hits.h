// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// What the rays of a radar have met.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "core/vec.h"
#include "rf/facets/facet_world.h"
#include "rf/radar/echoes/ray_grid.h"

namespace greatx::rf {

/// [bounce][tube]: a facet or nothing, and whether the receiver is seen from there.
class RayHits {
 public:
  static constexpr uint32_t nothing = ~0u;

  /// `words` of EchoPass::collect, [bounces * tubes].
  RayHits(std::span<const uint32_t> words, uint32_t tubes);
  /// Of a monostatic radar: from a second or later surface it is seen if one of its own rays about that
  /// direction (the tube's or one of the eight around it) meets the surface first; from what lies beyond the
  /// field of view it is not. From the second of two surfaces of which the first is a mirror to it, it is not
  /// either: that way is found backwards. With max_bounces >= mirror_bounces also where it is seen over the
  /// first surface, if that is a mirror to the one met: from the second surface, by which the tube came, it
  /// is; from later ones if one of the radar's rays about that direction meets the two in turn. Beyond
  /// max_bounces hits stay of such tubes alone.
  void find_seen(const RayGrid& grid, const FacetWorld& world, const dvec3& radar, uint32_t max_bounces,
                 uint32_t threads);

  uint32_t tubes() const { return tubes_; }
  uint32_t bounces() const { return bounces_; }
  uint32_t word(uint32_t tube, uint32_t bounce) const { return words_[size_t{bounce} * tubes_ + tube]; }
  static uint32_t facet(uint32_t word);
  static bool met(uint32_t word) { return facet(word) != nothing; }
  static bool sees_receiver(uint32_t word);
  /// Over the first surface of the tube.
  static bool sees_over(uint32_t word);

 private:
  /// Whether `tube` or one around it meets `wanted` after `before`, if that is a facet, else first.
  bool seen_about(const RayGrid& grid, uint32_t tube, uint32_t wanted, uint32_t before = nothing) const;

  std::vector<uint32_t> words_;
  uint32_t tubes_, bounces_;
};

}  // namespace greatx::rf
