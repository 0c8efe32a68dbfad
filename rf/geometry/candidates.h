// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Describes candidates: sequences of facets that a path may touch, in this order. The exact geometry decides
// which candidates have a path.
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

/// Holds facet sequences in a flat list. Each sequence runs outwards from the source, the end that the search
/// started from (transmitter or receiver). A sequence holds only the reflecting facets, and not the walls
/// that a path passes through. The empty sequence stands for the line of sight, which is examined only if the
/// list holds it. The canonical order is by depth and then by facet indices, without duplicates.
struct CandidateList {
  std::vector<uint32_t> facets;      ///< all sequences, one after the other
  std::vector<uint32_t> offsets{0};  ///< [size + 1] into facets
  /// [size], or empty if unknown: the part of its last facet at which a sequence can be reflected. A window
  /// is never too small.
  std::vector<PlaneWindow> windows;
  /// [size + 1] into `wedges`, or empty if wedges were not searched for.
  std::vector<uint32_t> wedge_offsets;
  /// Wedges that the beam of a sequence may reach, ascending for each sequence.
  std::vector<uint32_t> wedges;
  size_t size() const { return offsets.size() - 1; }
  std::span<const uint32_t> sequence(size_t index) const {
    return std::span(facets).subspan(offsets[index], offsets[index + 1] - offsets[index]);
  }
  std::span<const uint32_t> wedges_of(size_t index) const {
    if (wedge_offsets.empty()) return {};
    return std::span(wedges).subspan(wedge_offsets[index], wedge_offsets[index + 1] - wedge_offsets[index]);
  }
  /// Appends a sequence. Call make_canonical() after the last one.
  void add(std::span<const uint32_t> sequence);
  /// Sorts the sequences and removes duplicates, comparing whole sequences. The list must have no windows and
  /// no wedges.
  void make_canonical();
  bool is_canonical() const;
  friend bool operator==(const CandidateList&, const CandidateList&) = default;
};

/// Counts the sequences for which a search had no room.
struct LeftOut {
  uint64_t sequences = 0;         ///< least number for one search; the largest of several searches
  uint32_t complete_depth = ~0u;  ///< every sequence that was left out has more facets than this
  void add(const LeftOut& other) {
    sequences = std::max(sequences, other.sequences);
    complete_depth = std::min(complete_depth, other.complete_depth);
  }
};

/// Tells whether a comes before b in the canonical order: fewer facets first, then lexicographic.
bool sequence_less(std::span<const uint32_t> a, std::span<const uint32_t> b);

}  // namespace greatx::rf
