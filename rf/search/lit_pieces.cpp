// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "rf/search/lit_pieces.h"

namespace greatx::rf {

void LitPieces::start(const Convex& whole) {
  pieces_.resize(std::max<size_t>(pieces_.size(), 1));
  pieces_[0].shape = whole;
  pieces_[0].box = whole.box();
  pieces_[0].walls = 0;
  live_.assign(1, 0);
  spare_.clear();
  for (auto piece = static_cast<uint32_t>(pieces_.size() - 1); piece > 0; --piece) spare_.push_back(piece);
  find_lots();
}

/// Finds the constraints that cut through a polygon. Returns false if the polygon is outside one of them.
bool LitPieces::find_cuts(const Convex& shape, const HalfPlane& front, std::span<const HalfPlane> outline) {
  cuts_.clear();
  const auto look = [&](const HalfPlane& half) {
    double least = 1e300, most = -1e300;
    for (uint32_t i = 0; i < shape.count; ++i) {
      const double value = half.at(shape.at[i]);
      least = std::min(least, value), most = std::max(most, value);
    }
    if (least < 0.0) cuts_.push_back(half);
    return most > 0.0;
  };
  return look(front) && std::all_of(outline.begin(), outline.end(), look);
}

/// Leaves the part inside all cuts in place and adds the parts outside.
void LitPieces::cut(uint32_t piece) {
  Convex inside, outside;
  for (const HalfPlane& half : cuts_) {
    split(pieces_[piece].shape, half, inside, outside);
    if (outside.count > 0) {
      LitPiece& added = pieces_[add_copy(piece)];
      added.shape = outside;
      added.box = outside.box();
    }
    pieces_[piece].shape = inside;
  }
  pieces_[piece].box = pieces_[piece].shape.box();
}

/// Adds a piece that has passed the same walls.
uint32_t LitPieces::add_copy(uint32_t piece) {
  if (spare_.empty()) {
    spare_.push_back(static_cast<uint32_t>(pieces_.size()));
    pieces_.emplace_back();
  }
  const uint32_t added = spare_.back();
  spare_.pop_back();
  pieces_[added].walls = pieces_[piece].walls;
  pieces_[added].passed = pieces_[piece].passed;
  live_.push_back(added);
  return added;
}

void LitPieces::remove_empty() {
  std::erase_if(live_, [&](uint32_t piece) {
    if (pieces_[piece].shape.count > 0) return false;
    spare_.push_back(piece);
    return true;
  });
  find_lots();
}

void LitPieces::find_lots() {
  lots_.assign((live_.size() + pieces_of_lot - 1) / pieces_of_lot, SlopeRect::none());
  for (size_t i = 0; i < live_.size(); ++i) lots_[i / pieces_of_lot].add(pieces_[live_[i]].box);
}

}  // namespace greatx::rf
