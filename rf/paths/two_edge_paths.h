// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Joins paths over two edges: reflections lead from the source to the first edge (prefix) and from the target
// to the second (suffix), and the path runs straight between the edges.
//
//   WedgeArrivals of the source ─┐
//   EdgePairs ───────────────────┼─► pairs of edges ─► keller_points ─► reflections ─► GeometricPath
//   WedgeArrivals of the target ─┘
#pragma once

#include <cstdint>
#include <vector>

#include "rf/config/path_limits.h"
#include "rf/geometry/geometry.h"
#include "rf/geometry/path.h"
#include "rf/paths/edge_pairs.h"
#include "rf/paths/radio_model.h"
#include "rf/paths/wedge_arrivals.h"

namespace greatx::rf {

/// Holds the ways from one end to wedges.
struct EdgeEnd {
  const ImageTree& tree;
  const WedgeArrivals& arrivals;
};

/// Appends every path from the source over two edges to the target, without walls, from the end of
/// `source.tree` on. `limits` bound the reflections on each side and all interactions. The order depends on
/// the arguments but `threads` alone.
void join_two_edges(const RadioModel& model, const PathLimits& limits, EdgePairs& pairs,
                    const EdgeEnd& source, const EdgeEnd& target, uint32_t threads,
                    std::vector<GeometricPath>& paths);

}  // namespace greatx::rf
