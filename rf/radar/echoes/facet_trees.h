// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// What a facet is made of, for tubes: its triangles joined to convex pieces across the edges that two of them
// share (a wall's two triangles become its rectangle), so that a tube on a wall is not cut along seams that
// send nothing back. Which pieces may a part of a tube fall on? Facets of many pieces (ground) have a tree of
// boxes.
#pragma once

#include <array>
#include <cstdint>
#include <ranges>
#include <span>
#include <vector>

#include "core/vec.h"
#include "rf/facets/facet_world.h"
#include "scene/description/box_tree.h"

namespace greatx::rf {

/// normal . x + offset >= 0.
struct KeptSide {
  dvec3 normal{0.0};
  double offset = 0.0;
};

class FacetTrees {
 public:
  static constexpr uint32_t most_corners = 8;  ///< of a piece

  explicit FacetTrees(const scene::Scene& scene);
  /// Indices of pieces, ascending, whose boxes are not wholly outside of one of the half-spaces (local
  /// coordinates).
  void find(const FacetWorld& world, uint32_t facet, std::span<const KeptSide> spaces,
            std::vector<uint32_t>& pieces) const;
  /// All pieces of a facet, and the corners of one in the frame of its body, counter-clockwise about the
  /// normal.
  std::ranges::iota_view<uint32_t, uint32_t> pieces(uint32_t facet) const {
    return {first_piece_[facet], first_piece_[facet + 1]};
  }
  std::span<const dvec3> corners(uint32_t piece) const {
    return std::span(corners_).subspan(pieces_[piece].first, pieces_[piece].count);
  }
  /// Corners of a piece in local coordinates, in `room` unless its body is the static one.
  std::span<const dvec3> corners(const FacetWorld& world, uint32_t facet, uint32_t piece,
                                 std::array<dvec3, most_corners>& room) const;
  /// FacetWorld::contains for a point in local coordinates, by the tree if there is one: 1e-9 of a side
  /// beyond it is inside.
  bool contains(const FacetWorld& world, uint32_t facet, const dvec3& point) const;

 private:
  static constexpr uint32_t small_facet = 8;
  struct Piece {
    uint32_t first = 0, count = 0;  ///< of corners_
  };
  scene::Bounds bounds_of(uint32_t piece) const;

  std::vector<dvec3> corners_;         ///< in the bodies' frames
  std::vector<Piece> pieces_;          ///< facet by facet
  std::vector<uint32_t> first_piece_;  ///< [facets + 1]
  /// [facets] of the facet's pieces, in the body's frame; empty where these are few.
  std::vector<scene::BoxTree> trees_;
};

}  // namespace greatx::rf
