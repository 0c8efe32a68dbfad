// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Finds the facets that a beam meets, and the regions of the facets where it meets them. The window is cut in
// two repeatedly (J. E. Warnock, 1969) until a cell holds few facets. In such a cell, everything in front of
// a facet is subtracted from the facet as polygons (K. Weiler, P. Atherton, 1977). Planes that cross need no
// order: the region where one is in front of the other is a half-plane of slopes.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "rf/search/beam_view.h"
#include "rf/search/leaf_covers.h"
#include "rf/search/lit_pieces.h"

namespace greatx::rf {

/// Bounds a convex region of a facet by a, b, a + b and a - b, in metres along BeamFacet::axis_a and axis_b.
struct FacetRegion {
  double min_a = 1e300, max_a = -1e300, min_b = 1e300, max_b = -1e300;
  double min_sum = 1e300, max_sum = -1e300, min_difference = 1e300, max_difference = -1e300;
  void add(double a, double b, double room);
  void add(const FacetRegion& other);
  bool empty() const { return min_a > max_a; }
};

/// Describes a facet that a beam meets behind `walls` more walls than the beam itself, and the region where
/// it meets it.
struct BeamHit {
  uint32_t facet = 0;  ///< index in the BeamScene
  uint32_t walls = 0;
  FacetRegion region;
};

class BeamCells {
 public:
  /// Appends all facets and wedges that the beam of `view` may meet behind at most `walls` walls. `hits` are
  /// ordered by facet and then by walls. `wedges` are indices in the list of wedges, ascending, each once.
  void settle(const BeamView& view, uint32_t walls, std::vector<BeamHit>& hits,
              std::vector<uint32_t>& wedges);
  uint64_t cells() const { return cells_; }  ///< number of cells examined since the start
  /// Returns the number of pairs of polygons compared since the start.
  uint64_t pairs() const { return covers_.compared(); }

 private:
  static constexpr uint32_t most_passed = LitPiece::most_passed;
  /// Describes an obstacle by constraints. Rays that satisfy all of them meet it.
  struct Outline {
    uint32_t first = 0, count = 0;  ///< range in halves_; count 0 if it is not computed yet
  };
  /// Describes a facet in a leaf.
  struct Entry {
    uint32_t facet = 0;  ///< facet of the view
    double min_depth = 0.0, max_depth = 0.0;
  };
  struct Interval {
    double from = 0.0, to = 1.0;
    uint32_t walls = 0;
    std::array<uint32_t, most_passed> passed{};
  };

  void look_at(const SlopeRect& rect, size_t first, size_t end, uint32_t level);
  void drop_hidden(const SlopeRect& rect, size_t first);
  bool covers(uint32_t facet, const SlopeRect& rect);
  void settle_leaf(const SlopeRect& rect, size_t first);
  std::array<HalfPlane, 8> sides_of(const SlopeRect& rect) const;
  void settle_facet(const SlopeRect& rect, const Entry& entry);
  void settle_polygon(const ViewFacet& facet, const Entry& entry, const Convex& whole);
  void settle_wedge(const SlopeRect& rect, const Entry& entry);
  HalfPlane in_front(const ViewFacet& cover, const ViewFacet& facet) const;
  bool apart(uint32_t wall, uint32_t other) const;
  bool passes_one_more(std::array<uint32_t, most_passed>& passed, uint32_t& walls, uint32_t wall) const;
  void subtract(Interval interval, uint32_t cover, double from, double to);
  std::span<const HalfPlane> outline(uint32_t polygon, const ViewFacet& facet);
  void add_to(FacetRegion& region, const ViewFacet& facet, const Convex& shape, double pad) const;

  const BeamView* view_ = nullptr;
  uint32_t walls_ = 0;
  std::vector<uint32_t> lists_;  ///< facets of the open cells
  std::vector<Entry> entries_;   ///< facets of the leaf, nearest first
  LeafCovers covers_;            ///< of the leaf
  LitPieces pieces_;
  std::vector<Interval> intervals_, next_intervals_;
  std::vector<HalfPlane> halves_;
  std::vector<Outline> outlines_;     ///< [polygons of the view]
  std::vector<FacetRegion> regions_;  ///< [facets of the view][walls + 1]
  std::vector<uint8_t> lit_;          ///< [facets of the view]: 1 for a visible wedge
  uint64_t cells_ = 0;
};

}  // namespace greatx::rf
