// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Holds the facets that the rays of a radar have met.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "core/vec.h"
#include "rf/facets/facet_world.h"
#include "rf/radar/echoes/ray_grid.h"

namespace greatx::rf {

/// Stores for each [bounce][tube] a facet or nothing, and whether the receiver is seen from there.
class RayHits {
 public:
  static constexpr uint32_t nothing = ~0u;

  /// Takes the `words` of EchoPass::collect, [bounces * tubes].
  RayHits(std::span<const uint32_t> words, uint32_t tubes);
  /// Marks the hits of a monostatic radar that see the receiver, from the second surface on.
  /// - A hit sees the receiver if one of the radar's own rays around its direction (that of the tube there or
  ///   of one of the eight around it) meets the surface first. Directions beyond the field of view see
  ///   nothing.
  /// - The second of two surfaces does not see the receiver if the first is a mirror for it. The search finds
  ///   that path in the opposite direction.
  /// - With max_bounces >= mirror_bounces, a hit also sees the receiver over the first surface of the tube if
  ///   that surface is a mirror for the one met. The second surface does, since the tube came that way. A
  ///   later surface does if one of the radar's rays around that direction meets the mirror and then the
  ///   surface.
  /// Deletes the hits beyond max_bounces, except those of tubes whose first surface is a mirror for the
  /// second.
  void find_seen(const RayGrid& grid, const FacetWorld& world, const dvec3& radar, uint32_t max_bounces,
                 uint32_t threads);

  uint32_t tubes() const { return tubes_; }
  uint32_t bounces() const { return bounces_; }
  uint32_t word(uint32_t tube, uint32_t bounce) const { return words_[size_t{bounce} * tubes_ + tube]; }
  static uint32_t facet(uint32_t word);
  static bool met(uint32_t word) { return facet(word) != nothing; }
  static bool sees_receiver(uint32_t word);
  /// Returns whether the receiver is seen over the first surface of the tube.
  static bool sees_over(uint32_t word);

 private:
  /// Returns whether `tube` or a tube around it meets `wanted` first, or, if `before` is a facet, meets
  /// `before` first and then `wanted`.
  bool seen_about(const RayGrid& grid, uint32_t tube, uint32_t wanted, uint32_t before = nothing) const;

  std::vector<uint32_t> words_;
  uint32_t tubes_, bounces_;
};

}  // namespace greatx::rf
