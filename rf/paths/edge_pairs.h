// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Finds which edges may see which. A path over two edges runs straight from one to the other, and of all
// pairs of edges of a city very few see each other.
//
//   wedge ─► tree of boxes of the others ─► boxes wholly behind one polygon, or inside the wedge, are cut off
//         ─► the wedges that are left (once for each wedge)
//
// The polygon P, which is convex, hides a set of points from an edge if every point lies in the pyramid
// behind P of both ends of the edge: a line from any place of the edge to a point then meets P between the
// places where the lines from the ends meet it. Only polygons that the line between both middles meets are
// tried. Hence the list of an edge is never too short, and somewhat too long. Bodies that move hide nothing,
// and their edges see every edge.
#pragma once

#include <cstdint>
#include <mutex>
#include <span>
#include <vector>

#include "rf/search/beam_scene.h"
#include "scene/description/wedges.h"

namespace greatx::rf {

class EdgePairs {
 public:
  /// `still` holds what does not move of a scene with these wedges, which must outlive this object.
  /// `max_walls`: facets of kind wall that a wave may pass between two edges.
  EdgePairs(const BeamScene& still, std::span<const scene::Wedge> wedges, uint32_t max_walls);

  /// Returns the wedges that a wedge may see, ascending, without itself. Many threads may call this.
  std::span<const uint32_t> seen_from(uint32_t wedge);

 private:
  /// A convex polygon that hides what is behind it.
  struct Blind {
    dvec3 normal{0.0};
    double offset = 0.0;
    double clear_m = 0.0;  ///< points nearer to the plane count as on both sides
    uint32_t first = 0, count = 0;
    uint32_t facet = 0;
    bool wall = false;
  };
  struct Row {
    std::once_flag once;
    std::vector<uint32_t> seen;
  };
  struct Inside;
  class Looker;
  void add_seen(uint32_t wedge, std::vector<uint32_t>& seen) const;
  std::span<const dvec3> corners(const Blind& blind) const {
    return std::span(corners_).subspan(blind.first, blind.count);
  }

  std::span<const scene::Wedge> wedges_;
  uint32_t max_walls_;
  std::vector<Blind> blinds_;
  std::vector<dvec3> corners_;
  std::vector<uint32_t> listed_;            ///< the wedges of `still`, ascending
  std::vector<uint32_t> moving_;            ///< those of bodies that move, ascending
  scene::BoxTree blind_tree_, wedge_tree_;  ///< over blinds_, and over listed_
  std::vector<Row> rows_;                   ///< [wedges]
};

}  // namespace greatx::rf
