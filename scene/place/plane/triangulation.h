// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// A constrained Delaunay triangulation of a rectangle, on exact predicates: points are inserted one by one
// (Lawson's flips), and edges are forced by flipping those that cross them (Sloan 1993). Edges to be forced
// must not cross each other; scene/place/plane/noding.h sees to that.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <unordered_map>
#include <utility>
#include <vector>

#include "scene/place/plane/grid.h"

namespace greatx::scene::place {

class Triangulation {
 public:
  static constexpr uint32_t none = 0xFFFFFFFFu;

  struct Triangle {
    std::array<uint32_t, 3> corners{};                 ///< counter-clockwise
    std::array<uint32_t, 3> across{none, none, none};  ///< the neighbour opposite corner i
    std::array<bool, 3> fixed{};                       ///< whether the edge opposite corner i is forced
  };

  /// Makes a rectangle of two triangles; its sides are forced. Throws UserError if an extent is not positive
  /// or exceeds most_extent_m.
  Triangulation(const GridPoint& low, const GridPoint& high);

  /// Adds a point within the rectangle and returns its index, or the index of the equal point that is there.
  uint32_t add(const GridPoint& point);
  /// Divides an edge at a place on it that was rounded to the grid: the edge then bends by a grid step at
  /// most, and stays forced if it was. Returns the new point, or nothing, and changes nothing, if the point
  /// is there already, if a triangle would turn over, or if the edge is the rectangle's and the point is not
  /// on it.
  std::optional<uint32_t> divide(uint32_t triangle, uint32_t side, const GridPoint& point);
  /// Forces the straight line between two points to be edges, through the points that lie on it. Throws
  /// UserError if it crosses a forced edge.
  void force(uint32_t from, uint32_t to);

  /// Returns a triangle that holds the point, inside or on its border.
  uint32_t find(const GridPoint& point) const;

  const std::vector<GridPoint>& points() const { return points_; }
  const std::vector<Triangle>& triangles() const { return triangles_; }
  /// Returns the triangles that changed since the last call, ascending, each once.
  std::vector<uint32_t> take_changed();

  /// Returns a number for each triangle: equal for triangles that are connected without crossing a forced
  /// edge. Numbers ascend from 0 in the order of the first triangle.
  std::vector<uint32_t> regions(uint32_t* count = nullptr) const;

 private:
  struct Side {
    uint32_t triangle, side;
  };
  using Ends = std::array<uint32_t, 2>;  ///< of an edge

  uint32_t find(const GridPoint& point, uint32_t start) const;
  void link(uint32_t triangle, uint32_t side, uint32_t other, uint32_t other_side);
  uint32_t side_towards(uint32_t triangle, uint32_t other) const;
  void split_triangle(uint32_t triangle, uint32_t point);
  void split_edge(uint32_t triangle, uint32_t side, uint32_t point);
  void flip(uint32_t triangle, uint32_t side);
  /// Restores the Delaunay property from the edges on the list (triangle, side).
  void legalise(std::vector<std::array<uint32_t, 2>> edges);
  void changed(uint32_t triangle);

  /// Calls visit(triangle, place of the corner in it) around a corner until it returns true.
  template <typename Visit>
  void turn_around(uint32_t corner, const Visit& visit) const;
  std::optional<Side> side_between(uint32_t a, uint32_t b) const;
  /// Returns the apex, the two ends of the edge, and the apex on the far side.
  std::array<uint32_t, 4> around(const Side& edge) const;
  void fix(const Side& edge);
  uint32_t force_step(uint32_t from, uint32_t to);
  /// Returns the first point on the line and the edges that cross the line before it.
  std::pair<uint32_t, std::vector<Ends>> edges_across(Side out, uint32_t from, uint32_t to) const;
  std::vector<Ends> clear(std::vector<Ends> crossed, uint32_t from, uint32_t to);
  void restore(std::vector<Ends> edges, uint32_t from, uint32_t to);

  struct Hash {
    size_t operator()(const GridPoint& p) const {
      uint64_t hash = static_cast<uint64_t>(p.x) * 0x9E3779B97F4A7C15u;
      hash = (hash ^ (hash >> 32) ^ static_cast<uint64_t>(p.y)) * 0xC2B2AE3D27D4EB4Fu;
      return static_cast<size_t>(hash ^ (hash >> 29));
    }
  };

  std::vector<GridPoint> points_;
  std::vector<Triangle> triangles_;
  std::vector<uint32_t> triangle_of_;                       ///< one triangle of each point
  std::unordered_map<GridPoint, uint32_t, Hash> index_of_;  ///< for look-ups alone, never iterated
  mutable uint32_t last_ = 0;                               ///< where the next search begins
  std::vector<uint32_t> changed_;
  std::vector<bool> is_changed_;
};

}  // namespace greatx::scene::place
