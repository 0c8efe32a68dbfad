// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Prepares facets for tubes: joins the triangles of a facet to convex pieces across shared edges (the two
// triangles of a wall become its rectangle). A tube on a wall is then not cut along seams that send nothing
// back. Facets with many pieces, such as ground, have a tree of boxes that finds the pieces on which a part
// of a tube may fall.
#pragma once

#include <array>
#include <compare>
#include <cstdint>
#include <ranges>
#include <span>
#include <vector>

#include "core/vec.h"
#include "rf/facets/facet_world.h"
#include "rf/radar/echoes/half_spaces.h"
#include "scene/description/box_tree.h"

namespace greatx::rf {

/// Names a convex piece of a facet.
struct FacetPiece {
  uint32_t facet = 0, piece = 0;  ///< the piece as FacetTrees::corners takes it
  auto operator<=>(const FacetPiece&) const = default;
};

class FacetTrees {
 public:
  static constexpr uint32_t most_corners = 8;  ///< largest number of corners of a piece

  explicit FacetTrees(const scene::Scene& scene);
  /// Returns the indices of the pieces whose boxes are not entirely outside one of the half-spaces,
  /// ascending. The half-spaces are in local coordinates.
  void find(const FacetWorld& world, uint32_t facet, std::span<const KeptSide> spaces,
            std::vector<uint32_t>& pieces) const;
  /// Returns the indices of all pieces of a facet.
  std::ranges::iota_view<uint32_t, uint32_t> pieces(uint32_t facet) const {
    return {first_piece_[facet], first_piece_[facet + 1]};
  }
  /// Returns the corners of a piece in the frame of its body, counter-clockwise about the normal.
  std::span<const dvec3> corners(uint32_t piece) const {
    return std::span(corners_).subspan(pieces_[piece].first, pieces_[piece].count);
  }
  /// Returns the corners of a piece in local coordinates. They are stored in `room` unless the body is the
  /// static one.
  std::span<const dvec3> corners(const FacetWorld& world, uint32_t facet, uint32_t piece,
                                 std::array<dvec3, most_corners>& room) const;
  /// Holds a ball around a piece, in local coordinates. It is 1 um larger than the piece, far more than the
  /// rounding errors of its corners.
  struct Ball {
    dvec3 center{0.0};
    double radius = 0.0;
  };
  Ball ball(const FacetWorld& world, uint32_t facet, uint32_t piece) const {
    const uint32_t body = world.facet(facet).body;
    if (body == 0) return pieces_[piece].ball;
    return {world.motion(body).pose.apply(pieces_[piece].ball.center), pieces_[piece].ball.radius};
  }
  /// Returns FacetWorld::contains for a point in local coordinates. Uses the tree if the facet has one; a
  /// point then counts as inside up to 1e-9 of the length of a side beyond that side.
  bool contains(const FacetWorld& world, uint32_t facet, const dvec3& point) const;

 private:
  static constexpr uint32_t small_facet = 8;
  struct Piece {
    uint32_t first = 0, count = 0;  ///< range of corners_
    Ball ball;                      ///< in the frame of the body
  };
  scene::Bounds bounds_of(uint32_t piece) const;

  std::vector<dvec3> corners_;         ///< in the frames of the bodies
  std::vector<Piece> pieces_;          ///< facet by facet
  std::vector<uint32_t> first_piece_;  ///< [facets + 1]
  /// [facets] trees of the pieces of each facet, in the frame of the body; empty for facets with few pieces.
  std::vector<scene::BoxTree> trees_;
};

}  // namespace greatx::rf
