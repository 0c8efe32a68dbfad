// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Candidates: which facets a path may touch, in which order. A candidate is a promise to look, not a path.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace greatx::rf {

/// Facet sequences from the transmitter to the receiver, flat. The empty sequence stands for the line of
/// sight: it is looked at only if the list holds it. Canonical order: by depth, then by facet indices; no
/// duplicates.
struct CandidateList {
  std::vector<uint32_t> facets;      ///< all sequences, one after the other
  std::vector<uint32_t> offsets{0};  ///< [size + 1] into facets

  size_t size() const { return offsets.size() - 1; }
  std::span<const uint32_t> sequence(size_t index) const {
    return std::span(facets).subspan(offsets[index], offsets[index + 1] - offsets[index]);
  }
  /// Appends; call make_canonical() when done.
  void add(std::span<const uint32_t> sequence);
  /// Sorts and removes duplicates, comparing whole sequences.
  void make_canonical();
  bool is_canonical() const;
  /// Every sequence from the other end, in canonical order.
  CandidateList reversed() const;
  friend bool operator==(const CandidateList&, const CandidateList&) = default;
};

/// a before b in the canonical order: fewer facets first, then lexicographic.
bool sequence_less(std::span<const uint32_t> a, std::span<const uint32_t> b);

/// Every sequence of `facet_count` facets up to `max_depth` without immediate repetition, line of sight
/// included: the reference for small scenes. Throws UserError if there are more than `max_sequences`.
CandidateList exhaustive_candidates(uint32_t facet_count, uint32_t max_depth,
                                    uint64_t max_sequences = 4'000'000);

}  // namespace greatx::rf
