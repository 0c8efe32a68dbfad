// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Holds the convex pieces of a polygon in slopes that nothing hides so far. A polygon near the horizon may
// have hundreds of pieces and be behind thousands of covers, so that most pairs are told apart by boxes.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "rf/search/convex.h"
#include "shaders/shared/rf.h"

namespace greatx::rf {

/// Holds a lit part of a facet: a convex shape, and the walls in front of it.
struct LitPiece {
  static constexpr uint32_t most_passed = shared::crossings_max;
  Convex shape;
  SlopeRect box;  ///< of the shape
  uint32_t walls = 0;
  std::array<uint32_t, most_passed> passed{};  ///< facets of the view
};

class LitPieces {
 public:
  /// Forgets everything and begins with one piece, which has passed no wall.
  void start(const Convex& whole);
  bool empty() const { return live_.empty(); }
  /// Calls visit(piece) for every piece.
  template <typename Visit>
  void for_each(const Visit& visit) const {
    for (const uint32_t piece : live_) visit(pieces_[piece]);
  }
  /// Cuts the pieces by the constraints. Where all hold, pass(piece) returns whether light passes there.
  template <typename Pass>
  void subtract(const HalfPlane& front, std::span<const HalfPlane> outline, const Pass& pass);

 private:
  /// Largest number of pieces. Further cuts are left out, so that the pieces stay too large.
  static constexpr size_t most_pieces = 512;
  /// Pieces that are next to each other in live_ and share a box.
  static constexpr size_t pieces_of_lot = 8;

  /// Tells whether no point of a box satisfies all constraints, by one of them alone. find_cuts() then says
  /// the same of every shape in the box, because the roundings of both are monotone.
  static bool is_apart(const SlopeRect& box, const HalfPlane& front, std::span<const HalfPlane> outline) {
    return front.most(box) <= 0.0 || std::any_of(outline.begin(), outline.end(), [&](const HalfPlane& half) {
             return half.most(box) <= 0.0;
           });
  }
  bool find_cuts(const Convex& shape, const HalfPlane& front, std::span<const HalfPlane> outline);
  void cut(uint32_t piece);
  uint32_t add_copy(uint32_t piece);
  void remove_empty();
  void find_lots();

  std::vector<LitPiece> pieces_;
  std::vector<uint32_t> live_;   ///< pieces in use, in the order in which they came to be
  std::vector<uint32_t> spare_;  ///< pieces that may be used again
  std::vector<SlopeRect> lots_;  ///< boxes of lots of live_
  std::vector<HalfPlane> cuts_;
};

template <typename Pass>
void LitPieces::subtract(const HalfPlane& front, std::span<const HalfPlane> outline, const Pass& pass) {
  const size_t count = live_.size();
  bool changed = false;
  for (size_t first = 0; first < count; first += pieces_of_lot) {
    if (is_apart(lots_[first / pieces_of_lot], front, outline)) continue;
    for (size_t i = first; i < std::min(count, first + pieces_of_lot); ++i) {
      const uint32_t piece = live_[i];
      if (is_apart(pieces_[piece].box, front, outline)) continue;
      if (!find_cuts(pieces_[piece].shape, front, outline)) continue;
      if (live_.size() + cuts_.size() > most_pieces) continue;
      if (pieces_[piece].shape.count + 2 * cuts_.size() > Convex::capacity) continue;
      cut(piece);
      if (!pass(pieces_[piece])) pieces_[piece].shape.count = 0;
      changed = true;
    }
  }
  if (changed) remove_empty();
}

}  // namespace greatx::rf
