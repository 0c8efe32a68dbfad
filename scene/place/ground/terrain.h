// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Makes the mesh of the ground: one triangulation of a rectangle, whose edges follow the areas on it and
// whose corners are taken from the samples of the terrain until it is near enough to all of them (greedy
// insertion, Garland and Heckbert 1995). One mesh has no cracks.
#pragma once

#include <vector>

#include "scene/place/ground/areas.h"
#include "scene/place/plane/triangulation.h"

namespace greatx::scene::place {

/// Height of the ground at any place: the terrain, or the nearest sample where it has no data, or 0 without
/// a terrain.
class GroundLevel {
 public:
  explicit GroundLevel(const HeightField& field);
  double operator()(const dvec2& place) const;
  /// Returns how many places had no data so far.
  size_t filled() const { return filled_; }

 private:
  double nearest(const dvec2& place) const;
  const HeightField& field_;
  std::vector<dvec3> known_;  ///< samples with data beside samples without, and the border's
  mutable size_t filled_ = 0;
};

struct TerrainMesh {
  Triangulation plan;
  std::vector<double> heights;   ///< of the points of the plan, m
  std::vector<Cover> covers;     ///< of each triangle
  double largest_error_m = 0.0;  ///< at the samples of the terrain within the rectangle; borders of areas
                                 ///< follow the terrain between the samples within the same bound
  size_t samples = 0;            ///< that were compared

  dvec3 point(uint32_t i) const { return dvec3(to_metres(plan.points()[i]), heights[i]); }
  /// Returns the height of the mesh at a place in the rectangle.
  double height_at(const dvec2& place) const;
};

/// Returns the height at `place` of the plane through a triangle's corners.
double height_in(const Triangulation& plan, const std::vector<double>& heights, uint32_t triangle,
                 const dvec2& place);

struct TerrainOptions {
  Box rectangle;
  double error_m = 0.25;
  double grid_m = 1.0 / 32.0;  ///< grid to which the borders of areas are rounded
  double simplify_m = 0.05;    ///< corners of borders go if the border then moves by less than this
};

TerrainMesh make_terrain(const HeightField& field, const GroundLevel& level,
                         const std::vector<GroundArea>& areas, const TerrainOptions& options);

}  // namespace greatx::scene::place
