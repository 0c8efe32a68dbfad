// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Divides line segments where they meet, and makes a triangulation whose regions are the faces between them.
#pragma once

#include <array>
#include <span>
#include <vector>

#include "core/vec.h"
#include "scene/place/plane/triangulation.h"

namespace greatx::scene::place {

using Segment = std::array<dvec2, 2>;  ///< m

/// Divides segments where they cross, touch or overlap, rounds all ends to multiples of `grid_m`, and drops
/// duplicates. The result's segments meet at ends only (snap rounding, GEOS's OverlayNG). `grid_m` is a whole
/// multiple of a grid unit. The order depends on the segments alone, not on their order.
std::vector<std::array<GridPoint, 2>> node(std::span<const Segment> segments, double grid_m);

/// Triangulates the rectangle with all of these edges forced.
Triangulation triangulate_noded(const GridPoint& low, const GridPoint& high,
                                std::span<const std::array<GridPoint, 2>> edges);

}  // namespace greatx::scene::place
