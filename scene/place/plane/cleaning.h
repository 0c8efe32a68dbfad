// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <vector>

#include "scene/place/plane/grid.h"

namespace greatx::scene::place {

using Edges = std::vector<std::array<GridPoint, 2>>;

struct CleaningOptions {
  double weld_m = 0.02;  ///< corners nearer than this become one, and edges this near to a corner pass it
  double straighten_m = 0.01;  ///< corners between two edges go if the line then moves by less than this
  double grid_m = 1.0 / grid_per_m;
};

/// Takes from noded edges what would give slivers: corners that nearly coincide, corners that nearly lie on
/// an edge, and corners at which a line nearly goes straight on (Douglas and Peucker 1973, between the
/// corners where lines meet). The result is noded. No line moves by more than twice the larger of the two
/// distances.
Edges cleaned(Edges edges, const CleaningOptions& options);

/// Returns the largest distance of any of the points from the nearest edge, if that is at most `most_m`;
/// otherwise `most_m`.
double largest_distance(const std::vector<dvec2>& points, const Edges& edges, double most_m);

}  // namespace greatx::scene::place
