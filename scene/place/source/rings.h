// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Joins the ways of a multipolygon to rings (OpenStreetMap wiki, "Relation:multipolygon"). Data flow: lists
// of node ids of the ways of one role ─► chains that share end nodes ─► rings, and chains that stay open.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "core/vec.h"
#include "scene/place/input/place_input.h"

namespace greatx::scene::place {

using NodeIds = std::vector<int64_t>;

struct JoinedRings {
  std::vector<NodeIds> closed;  ///< the first node is not repeated
  std::vector<NodeIds> open;    ///< chains whose ends meet nothing
};

/// Joins ways at their ends, in the order of the ways. A chain that comes back to one of its junctions gives
/// a ring at once, so that rings that touch in a node stay apart.
JoinedRings join_ways(std::span<const NodeIds> ways);

/// Puts each inner ring into the smallest outer ring that has most of its corners. Returns the polygons in
/// the order of the outer rings; `lost` gets the numbers of inner rings in no outer one.
std::vector<Polygon> nest_rings(std::vector<Ring> outer, std::vector<Ring> inner, std::vector<size_t>& lost);

/// Removes corners that repeat the one before, the last as before the first. Returns how many went.
size_t drop_repeated(Ring& ring);
/// Returns the number of corners at different places.
size_t distinct_corners(std::span<const dvec2> points);

}  // namespace greatx::scene::place
