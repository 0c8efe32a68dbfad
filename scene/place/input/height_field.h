// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Heights at the samples of grids. A grid of a file is regular in the file's own coordinates; in the scene's
// frame its rows and columns are slightly curved. Each sample therefore keeps its exact place.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "core/vec.h"

namespace greatx::scene::place {

/// The samples of one file within the area (and one sample around it).
struct HeightGrid {
  uint32_t columns = 0, rows = 0;
  std::vector<dvec3> samples;  ///< [rows, columns], m in the scene's frame; z is NaN where there is no data
  std::string source;
};

class HeightField {
 public:
  /// Adds a grid. Where grids overlap, the earlier one counts, unless it has no data there. Throws
  /// ContractError if the grid has fewer than 2 x 2 samples or its rows and columns do not span an area.
  void add(HeightGrid grid);
  bool empty() const { return grids_.empty(); }
  const std::vector<HeightGrid>& grids() const { return grids_; }

  /// Returns the height at a place: bilinear between the four samples around it. At a cell with a corner
  /// without data, the corners with data count by their bilinear weights if they have at least half of the
  /// weight. A pixel covers half a cell around its sample: at a place in no cell of any grid, but within half
  /// a cell of one, the height at that grid's edge counts, so that tiles side by side leave no gap. Returns
  /// nothing elsewhere and where there are no data.
  std::optional<double> at(const dvec2& place) const;

 private:
  /// How a grid is searched. The affine fit of (column, row) starts the search; Newton steps within the cells
  /// that they lead to end it.
  struct Lookup {
    glm::dmat3x2 cell_from_place{0.0};
    dvec2 low{0.0}, high{0.0};  ///< box of all samples, m
  };
  /// Returns (column, row) up to `outside` cells beyond the edge, moved to the edge.
  static std::optional<dvec2> cell_of(const HeightGrid& grid, const Lookup& lookup, const dvec2& place,
                                      double outside);
  static std::optional<double> height_in(const HeightGrid& grid, const dvec2& cell);
  std::vector<HeightGrid> grids_;
  std::vector<Lookup> lookups_;
};

}  // namespace greatx::scene::place
