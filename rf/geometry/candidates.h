// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Candidates: which facets a path may touch, in which order. A candidate is a promise to look, not a path.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace greatx::rf {

/// A rectangle in the plane coordinates (u, v) of a facet (PosedFacet), metres.
struct PlaneWindow {
  double min_u, max_u, min_v, max_v;
  friend bool operator==(const PlaneWindow&, const PlaneWindow&) = default;
};

/// Facet sequences, flat, each from the end that was searched from (the source: transmitter or receiver)
/// outwards: the reflecting facets alone, walls that a path passes through are none of them. The empty
/// sequence stands for the line of sight: it is looked at only if the list holds it. Canonical order: by
/// depth, then by facet indices; no duplicates.
struct CandidateList {
  std::vector<uint32_t> facets;      ///< all sequences, one after the other
  std::vector<uint32_t> offsets{0};  ///< [size + 1] into facets
  /// [size] or empty (not known): where on its last facet a sequence can be reflected at all. Never too
  /// small.
  std::vector<PlaneWindow> windows;
  /// [size + 1] or empty (not searched for), into `wedges`: wedges that the sequence's beam may reach,
  /// ascending.
  std::vector<uint32_t> wedge_offsets;
  std::vector<uint32_t> wedges;

  size_t size() const { return offsets.size() - 1; }
  std::span<const uint32_t> sequence(size_t index) const {
    return std::span(facets).subspan(offsets[index], offsets[index + 1] - offsets[index]);
  }
  std::span<const uint32_t> wedges_of(size_t index) const {
    if (wedge_offsets.empty()) return {};
    return std::span(wedges).subspan(wedge_offsets[index], wedge_offsets[index + 1] - wedge_offsets[index]);
  }
  /// Appends; call make_canonical() when done.
  void add(std::span<const uint32_t> sequence);
  /// Sorts and removes duplicates, comparing whole sequences. For lists without windows and wedges.
  void make_canonical();
  bool is_canonical() const;
  friend bool operator==(const CandidateList&, const CandidateList&) = default;
};

/// What a search had no room for.
struct LeftOut {
  uint64_t sequences = 0;         ///< at least, of one search: the most of several
  uint32_t complete_depth = ~0u;  ///< all of them have more facets than this
  void add(const LeftOut& other) {
    sequences = std::max(sequences, other.sequences);
    complete_depth = std::min(complete_depth, other.complete_depth);
  }
};

/// a before b in the canonical order: fewer facets first, then lexicographic.
bool sequence_less(std::span<const uint32_t> a, std::span<const uint32_t> b);

/// Every sequence of `facet_count` facets up to `max_depth` without immediate repetition, line of sight
/// included: the reference for small scenes. Throws UserError if there are more than `max_sequences`.
CandidateList exhaustive_candidates(uint32_t facet_count, uint32_t max_depth,
                                    uint64_t max_sequences = 4'000'000);

}  // namespace greatx::rf
