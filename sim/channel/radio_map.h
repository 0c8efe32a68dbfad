// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Radio maps: the links from all transmitters of a channel to the centres of a grid's cells, by the paths
// that a receiver put there would have, to the bit. sim/channel/radio_map_run.h makes whole maps of these
// steps.
//
//   MapGrid ─► place_cells ─► MapCells { z, placement } ─► RadioMapSolver ─► LinkStatistics [cells, tx] ─►
// map_arrays
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "core/vec.h"
#include "rf/channel/statistics.h"
#include "sim/channel/channel_snapshot.h"
#include "sim/channel/radio_map_ground.h"

namespace greatx::sim {

/// Squares over a rectangle of the world's x (east) and y (north). Cell = row * columns + column; row 0 is
/// the southernmost, column 0 the westernmost.
struct MapGrid {
  dvec2 min_m{0.0};  ///< the south-western corner, world
  double cell_m = 1.0;
  uint32_t columns = 1, rows = 1;

  size_t cells() const { return size_t{columns} * rows; }
  /// World x, y of the middle: min + (index + 0.5) * cell.
  dvec2 center(size_t cell) const {
    return {min_m.x + (static_cast<double>(cell % columns) + 0.5) * cell_m,
            min_m.y + (static_cast<double>(cell / columns) + 0.5) * cell_m};
  }
  dvec2 max_m() const { return min_m + cell_m * dvec2(columns, rows); }
};

/// The most links (cells times transmitters) that a map may have.
inline constexpr size_t most_map_links = 4'000'000;

/// As many cells as cover the rectangle: where its sides are no multiples of the cell, the last row and
/// column stick out. Throws UserError naming `--cell`, `--min` or `--max` if the cell is not above 0, the
/// rectangle is empty or there would be more than most_map_links.
MapGrid make_map_grid(const dvec2& min_m, const dvec2& max_m, double cell_m, size_t transmitters);

/// Corners that are not given are the scene's. Throws UserError like make_map_grid, and if the scene is
/// empty. `cell_m` none: 1, 2 or 5 times a power of ten, at most 150 along the longer side.
MapGrid map_grid_of(const std::optional<dvec2>& min_m, const std::optional<dvec2>& max_m,
                    std::optional<double> cell_m, const scene::Scene& scene, size_t transmitters);

/// How high the cells are: at one height of the world, or above what lies beneath each.
struct MapHeight {
  std::optional<double> plane_z_m;  ///< none: draped
  double above_m = 1.5;
  MapOver over = MapOver::ground;
};

/// Where a cell's middle stands; values go to disk.
enum class CellPlacement : uint8_t {
  free = 0,
  solid = 1,            ///< inside something that is not foliage
  nothing_beneath = 2,  ///< draped, and there is no ground
  foliage = 3,
  on_surface = 4,  ///< within the visibility tolerance of one (rf/facets/placement.h)
  beneath = 5,     ///< an open surface, with nothing below (rf/facets/placement.h)
};

/// A box, world coordinates, that holds the middles of all cells, wherever the ground beneath them is.
scene::Bounds bounds_of_cells(const MapGrid& grid, const MapHeight& height, const scene::Scene& scene);

struct MapCells {
  MapGrid grid;
  std::vector<double> z_m;               ///< [cells] world; NaN: nothing beneath
  std::vector<CellPlacement> placement;  ///< [cells]
  bool solve_inside = false;             ///< cells inside solids have values, too
  std::string height_rule;               ///< in words

  dvec3 point(size_t cell) const { return {grid.center(cell), z_m[cell]}; }
  /// Whether the cell has values.
  bool solved(size_t cell) const {
    return placement[cell] != CellPlacement::nothing_beneath &&
           (solve_inside || placement[cell] != CellPlacement::solid);
  }
};

/// `kinds` of the channel's facets, `bodies` as they stand (Moment::bodies). Throws UserError, naming the
/// field and the scene's bounds, if the rectangle misses the scene, the plane lies above or below everything
/// in the scene and `ends` (world positions of the transmitters), or no cell has anything beneath; with
/// `beyond_scene` only if the plane is not a number or no cell has anything beneath.
MapCells place_cells(const MapGrid& grid, const MapHeight& height, const scene::Scene& scene,
                     const rf::FacetKinds& kinds, std::span<const Pose> bodies, std::span<const dvec3> ends,
                     bool beyond_scene);

/// The receiver that is put into every cell, at rest.
struct MapReceiver {
  rf::AntennaArray array;  ///< by default one isotropic element, vertically polarized
  dquat orientation{1.0, 0.0, 0.0, 0.0};
};

class RadioMapSolver {
 public:
  /// `snapshot` outlives this and has all transmitters that the map has.
  RadioMapSolver(ChannelSnapshot& snapshot, MapReceiver receiver);

  /// Hands over the links of the cells from `first` on, in the order of cells, some hundred at a time:
  /// [cells, tx]; those of cells without values have no path. Ends early if `take` returns false. No cell
  /// depends on another, nor on `first`.
  using Take = std::function<bool(std::span<const rf::LinkStatistics>)>;
  void solve(const MapCells& cells, size_t first, const Take& take);

 private:
  std::vector<rf::LinkStatistics> statistics_of(std::span<const ChannelSnapshot::Link> links) const;

  ChannelSnapshot& snapshot_;
  double carrier_hz_ = 0.0;
  MapReceiver receiver_;
  std::vector<rf::AntennaArray> transmitters_;  ///< [transmitters of the channel]
};

/// Of a link without any path: gain 0, all that follows it NaN.
rf::LinkStatistics no_link();

}  // namespace greatx::sim
