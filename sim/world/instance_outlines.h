// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Outlines of what stands still, as a map shows them: where a level plane at half of an instance's height
// cuts its triangles. Walls that are plumb have the same outline at any height.
//
//   triangles of an instance  ─► a line for each triangle that the plane cuts
//                             ─► lines that continue each other are joined, so that a wall is one line
#pragma once

#include <optional>
#include <vector>

#include "sim/world/world.h"

namespace greatx::sim {

struct InstanceOutline {
  struct Line {
    dvec2 from{0.0}, to{0.0};
  };
  double height_m = 0.0;    ///< of the plane, in the world
  std::vector<Line> lines;  ///< in the world, metres, rounded to millimetres; ascending
};

/// An instance whose outline has more lines has none: it is no building, or one with all of its details.
inline constexpr size_t most_outline_lines = 2000;

/// Returns [instances] outlines: of buildings and of instances without a class, if they never move and are at
/// least 2 m high. The others, and those that the plane does not cut, have none.
std::vector<std::optional<InstanceOutline>> instance_outlines(const World& world);

}  // namespace greatx::sim
