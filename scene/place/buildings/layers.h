// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// The plan of all buildings, divided into regions with layers. Only complex.cpp uses it.
#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <utility>
#include <vector>

#include "scene/place/buildings/building.h"
#include "scene/place/plane/cleaning.h"
#include "scene/place/plane/noding.h"

namespace greatx::scene::place {

/// A building in a region, from a bottom to a top plane.
struct Layer {
  uint32_t building = 0, part = 0;
  Plane bottom, top;
  uint32_t roof_face = 0;
};

/// An edge of the plan between two regions.
struct PlanEdge {
  uint32_t from = 0, to = 0;  ///< points; the left region is on the left of the way
  uint32_t left = 0, right = 0;
};

struct Plan {
  Triangulation triangulation;
  std::vector<uint32_t> region_of;  ///< of each triangle
  std::vector<dvec2> middles;       ///< a point within each region, m
  std::vector<double> areas_m2;     ///< of each region
  std::vector<PlanEdge> edges;
  std::vector<std::vector<Layer>> layers;  ///< of each region, from the bottom up, without overlaps
  /// Area in which a building gave way to another one, by (building, the other), m^2.
  std::map<std::pair<uint32_t, uint32_t>, double> overlaps;

  dvec2 place(uint32_t point) const { return to_metres(triangulation.points()[point]); }
};

/// Divides the outlines and roof edges of all buildings where they meet, and cleans them.
Edges noded_outlines(const std::vector<Building>& buildings, const CleaningOptions& cleaning);
/// Triangulates the plan; its regions have no layers yet.
Plan divided_plan(const Edges& edges);
/// Fills the regions with layers, in place of those that they have. A region whose mean width (twice its
/// area over its perimeter) is below `narrow_m`, such as a wedge between walls that nearly touch, gets the
/// layers of the neighbour with the longest border.
void fill_layers(Plan& plan, const std::vector<Building>& buildings, double narrow_m);

/// Two planes that meet at an edge cross each other between its ends, at `share` of the way.
struct PlaneCrossing {
  uint32_t edge = 0;  ///< into Plan::edges
  double share = 0.0;
  /// The end that the crossing is so near to that a corner of its own would make a sliver, or `none`, and the
  /// heights of the planes there.
  uint32_t corner = Triangulation::none;
  double low = 0.0, high = 0.0;
};
std::vector<PlaneCrossing> plane_crossings(const Plan& plan);
/// Returns the edges with a corner at each crossing that is not near an end; the same edges if there is none.
Edges divided_at(const std::vector<PlaneCrossing>& crossings, const Plan& plan, const Edges& edges);

}  // namespace greatx::scene::place
