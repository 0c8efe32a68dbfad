// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "scene/place/input/height_field.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <utility>

#include "core/error.h"

namespace greatx::scene::place {

namespace {

dvec2 sample_place(const HeightGrid& grid, uint32_t column, uint32_t row) {
  return dvec2(grid.samples[static_cast<size_t>(row) * grid.columns + column]);
}

/// Returns the affine map (x, y, 1) -> (column, row) through three corners of the grid.
glm::dmat3x2 affine_cells(const HeightGrid& grid) {
  const dvec2 origin = sample_place(grid, 0, 0);
  const dvec2 along = (sample_place(grid, grid.columns - 1, 0) - origin) / double(grid.columns - 1);
  const dvec2 across = (sample_place(grid, 0, grid.rows - 1) - origin) / double(grid.rows - 1);
  const double area = along.x * across.y - along.y * across.x;
  GREATX_CHECK(std::isfinite(area) && std::abs(area) > 1e-12 * glm::length(along) * glm::length(across),
               "{}: rows and columns of {} x {} samples span no area", grid.source, grid.columns, grid.rows);
  const dvec2 columns(across.y / area, -along.y / area), rows(-across.x / area, along.x / area);
  return {columns, rows, -(columns * origin.x + rows * origin.y)};
}

/// The step and the greatest number of steps of the search: the remainder after a step falls with its square,
/// because the cells of a file are nearly parallelograms.
constexpr double search_tolerance = 1e-9;
constexpr int search_steps = 30;
/// How far, in cells, a place may lie beyond the outermost samples and still count as on the edge.
constexpr double edge_tolerance = 1e-6;

}  // namespace

void HeightField::add(HeightGrid grid) {
  GREATX_CHECK(grid.columns >= 2 && grid.rows >= 2 &&
                   grid.samples.size() == static_cast<size_t>(grid.columns) * grid.rows,
               "{}: {} x {} with {} samples", grid.source, grid.columns, grid.rows, grid.samples.size());
  Lookup lookup;
  lookup.cell_from_place = affine_cells(grid);
  lookup.low = dvec2(std::numeric_limits<double>::infinity());
  lookup.high = -lookup.low;
  for (const dvec3& sample : grid.samples) {
    lookup.low = glm::min(lookup.low, dvec2(sample));
    lookup.high = glm::max(lookup.high, dvec2(sample));
  }
  grids_.push_back(std::move(grid));
  lookups_.push_back(lookup);
}

std::optional<dvec2> HeightField::cell_of(const HeightGrid& grid, const Lookup& lookup, const dvec2& place,
                                          double outside) {
  const dvec2 slack = 1e-3 + outside * 2.0 * (lookup.high - lookup.low) /
                                 static_cast<double>(std::min(grid.columns, grid.rows) - 1);
  if (glm::any(glm::lessThan(place, lookup.low - slack)) ||
      glm::any(glm::greaterThan(place, lookup.high + slack)))
    return std::nullopt;
  const dvec2 most(grid.columns - 1, grid.rows - 1);
  dvec2 cell = lookup.cell_from_place * dvec3(place, 1.0);
  for (int step = 0; step < search_steps; ++step) {
    const dvec2 corner = glm::clamp(glm::floor(cell), dvec2(0.0), most - 1.0);
    const auto column = static_cast<uint32_t>(corner.x), row = static_cast<uint32_t>(corner.y);
    const dvec2 a = sample_place(grid, column, row), b = sample_place(grid, column + 1, row),
                c = sample_place(grid, column, row + 1), d = sample_place(grid, column + 1, row + 1);
    const dvec2 in_cell = cell - corner, twist = a - b - c + d;
    const dvec2 missing =
        place - (a + in_cell.x * (b - a) + in_cell.y * (c - a) + in_cell.x * in_cell.y * twist);
    const dvec2 du = b - a + in_cell.y * twist, dv = c - a + in_cell.x * twist;
    const double area = du.x * dv.y - du.y * dv.x;
    if (!(std::abs(area) > 0.0)) return std::nullopt;
    const dvec2 move((missing.x * dv.y - missing.y * dv.x) / area,
                     (du.x * missing.y - du.y * missing.x) / area);
    cell += move;
    if (std::max(std::abs(move.x), std::abs(move.y)) > search_tolerance) continue;
    if (glm::any(glm::lessThan(cell, dvec2(-outside))) || glm::any(glm::greaterThan(cell, most + outside)))
      return std::nullopt;
    return glm::clamp(cell, dvec2(0.0), most);
  }
  return std::nullopt;
}

std::optional<double> HeightField::height_in(const HeightGrid& grid, const dvec2& cell) {
  const dvec2 corner = glm::min(glm::floor(cell), dvec2(grid.columns - 2, grid.rows - 2));
  const dvec2 part = cell - corner;
  const size_t first = static_cast<size_t>(corner.y) * grid.columns + static_cast<size_t>(corner.x);
  const std::array<std::pair<size_t, double>, 4> corners{{{first, (1.0 - part.x) * (1.0 - part.y)},
                                                          {first + 1, part.x * (1.0 - part.y)},
                                                          {first + grid.columns, (1.0 - part.x) * part.y},
                                                          {first + grid.columns + 1, part.x * part.y}}};
  double height = 0.0, known = 0.0;
  for (const auto& [sample, weight] : corners) {
    const double z = grid.samples[sample].z;
    if (std::isnan(z)) continue;
    height += weight * z;
    known += weight;
  }
  // The slack keeps a place half-way between two samples from depending on rounding.
  if (known < 0.5 - 1e-9) return std::nullopt;
  return height / known;
}

std::optional<double> HeightField::at(const dvec2& place) const {
  for (const double outside : {edge_tolerance, 0.5 + edge_tolerance})
    for (size_t i = 0; i < grids_.size(); ++i)
      if (const auto cell = cell_of(grids_[i], lookups_[i], place, outside))
        if (const auto height = height_in(grids_[i], *cell)) return height;
  return std::nullopt;
}

}  // namespace greatx::scene::place
