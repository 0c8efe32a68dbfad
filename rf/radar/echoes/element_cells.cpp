// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "rf/radar/echoes/element_cells.h"

#include <algorithm>

#include "rf/radar/echoes/tube_beam.h"

namespace greatx::rf {
namespace {

FieldVector slope(const FieldVector& ahead, const FieldVector& behind, double step) {
  return {(ahead.re - behind.re) / (2.0 * step), (ahead.im - behind.im) / (2.0 * step)};
}

FieldVector turned_field(const FieldVector& field, const dmat3& turn) {
  return {turn * field.re, turn * field.im};
}

}  // namespace

ElementCells::ElementCells(const EchoOptions& options, const ElementPattern& pattern, double slant) {
  const RayGrid grid(options, Pose{});
  const TurnedElement element(pattern, std::span(&slant, 1), dquat(1.0, 0.0, 0.0, 0.0));
  cells_.reserve(grid.size());
  for (uint32_t tube = 0; tube < grid.size(); ++tube) {
    const TubeBeam beam({}, grid.axis(tube));
    // The slope is that over half a cell, where the field is asked for.
    double step = 0.0;
    for (const dvec3& corner : grid.corners(tube))
      step = std::max(step, 0.5 * glm::distance(corner, beam.axis));
    const auto at = [&](double x, double y) {
      return field_towards(element, glm::normalize(beam.axis + x * beam.e1 + y * beam.e2));
    };
    cells_.push_back({beam.axis, beam.e1, beam.e2, at(0.0, 0.0), slope(at(step, 0.0), at(-step, 0.0), step),
                      slope(at(0.0, step), at(0.0, -step), step)});
  }
}

CellField ElementCells::turned(uint32_t cell, const dmat3& turn) const {
  const CellField& own = cells_[cell];
  return {turn * own.axis,
          turn * own.e1,
          turn * own.e2,
          turned_field(own.middle, turn),
          turned_field(own.along_1, turn),
          turned_field(own.along_2, turn)};
}

}  // namespace greatx::rf
