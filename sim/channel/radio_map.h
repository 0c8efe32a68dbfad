// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Computes radio maps: the links from all transmitters of a channel to the centres of the cells of a grid.
// The links are bitwise equal to those of a receiver at each centre. sim/channel/radio_map_run.h makes whole
// maps of these steps.
//
//   MapGrid ─► place_cells ─► MapCells { z, placement } ─► RadioMapSolver ─► MapLink [cells, tx]
//           ─► map_array
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "core/vec.h"
#include "sim/channel/channel_snapshot.h"
#include "sim/channel/map_precoder.h"
#include "sim/channel/radio_map_ground.h"

namespace greatx::sim {

/// Describes square cells over a rectangle of the world's x (east) and y (north). Cell = row * columns +
/// column. Row 0 is the southernmost, column 0 the westernmost.
struct MapGrid {
  dvec2 min_m{0.0};  ///< the south-western corner, world
  double cell_m = 1.0;
  uint32_t columns = 1, rows = 1;

  size_t cells() const { return size_t{columns} * rows; }
  /// Returns the world x, y of the centre of a cell: min + (index + 0.5) * cell.
  dvec2 center(size_t cell) const {
    return {min_m.x + (static_cast<double>(cell % columns) + 0.5) * cell_m,
            min_m.y + (static_cast<double>(cell / columns) + 0.5) * cell_m};
  }
  dvec2 max_m() const { return min_m + cell_m * dvec2(columns, rows); }
};

/// The most links (cells times transmitters) that a map may have.
inline constexpr size_t most_map_links = 4'000'000;

/// Returns the grid with as many cells as cover the rectangle. Where a side is no multiple of the cell, the
/// last row or column extends beyond it. Throws UserError naming `--cell`, `--min` or `--max` if the cell is
/// not above 0, if a corner is not finite, if the rectangle is empty, or if there are more links than
/// most_map_links.
MapGrid make_map_grid(const dvec2& min_m, const dvec2& max_m, double cell_m, size_t transmitters);

/// Returns the grid of a map. Corners that are not given are those of the scene. If `cell_m` is not given, it
/// is 1, 2 or 5 times a power of ten such that the longer side has at most 150 cells. Throws UserError like
/// make_map_grid, and if the scene is empty and a corner is not given.
MapGrid map_grid_of(const std::optional<dvec2>& min_m, const std::optional<dvec2>& max_m,
                    std::optional<double> cell_m, const scene::Scene& scene, size_t transmitters);

/// Describes the height of the cells: one height in the world, or a height above the surface beneath each
/// cell.
struct MapHeight {
  std::optional<double> plane_z_m;  ///< none: draped
  double above_m = 1.5;
  MapOver over = MapOver::ground;
};

/// Says where the centre of a cell lies. The values are written to disk.
enum class CellPlacement : uint8_t {
  free = 0,
  solid = 1,            ///< inside a solid other than foliage
  nothing_beneath = 2,  ///< draped, and there is no surface beneath
  foliage = 3,
  on_surface = 4,  ///< within the visibility tolerance of a surface (rf/facets/placement.h)
  beneath = 5,     ///< beneath an open surface, with nothing below (rf/facets/placement.h)
};

/// Returns a box, world coordinates, that contains the centres of all cells for any height of the ground
/// beneath.
scene::Bounds bounds_of_cells(const MapGrid& grid, const MapHeight& height, const scene::Scene& scene);

/// Holds the cells of a map with their heights and placements.
struct MapCells {
  MapGrid grid;
  std::vector<double> z_m;               ///< [cells] world; NaN: nothing beneath
  std::vector<CellPlacement> placement;  ///< [cells]
  bool solve_inside = false;             ///< cells inside solids have values, too
  std::string height_rule;               ///< in words

  dvec3 point(size_t cell) const { return {grid.center(cell), z_m[cell]}; }
  /// Returns whether the cell has values.
  bool solved(size_t cell) const {
    return placement[cell] != CellPlacement::nothing_beneath &&
           (solve_inside || placement[cell] != CellPlacement::solid);
  }
};

/// Computes the heights and placements of all cells. `kinds` are those of the channel's facets, and `bodies`
/// the poses of bodies at the moment (Moment::bodies). Throws UserError if a height is not valid or no cell
/// has anything beneath it. Unless `beyond_scene` is set, it also throws, naming the field and the bounds of
/// the scene, if the rectangle misses the scene, or if the plane lies above or below everything in the scene
/// and all `ends` (world positions of the transmitters).
MapCells place_cells(const MapGrid& grid, const MapHeight& height, const scene::Scene& scene,
                     const rf::FacetKinds& kinds, std::span<const Pose> bodies, std::span<const dvec3> ends,
                     bool beyond_scene);

/// Describes the receiver in every cell, at rest.
struct MapReceiver {
  rf::AntennaArray array;  ///< by default one isotropic element, vertically polarized
  dquat orientation{1.0, 0.0, 0.0, 0.0};
};

/// Solves the links of a map.
class RadioMapSolver {
 public:
  /// `snapshot` outlives this and has all transmitters of the map. Throws UserError like MapBeams.
  RadioMapSolver(ChannelSnapshot& snapshot, MapReceiver receiver, const MapPrecoder& precoder = {});

  /// Hands over the links [cells, tx] of the cells from `first` on, in the order of cells, a few hundred
  /// cells at a time. The links of cells without values have no paths. Ends early if `take` returns false.
  /// The links of a cell depend neither on other cells nor on `first`.
  using Take = std::function<bool(std::span<const MapLink>)>;
  void solve(const MapCells& cells, size_t first, const Take& take);

 private:
  std::vector<MapLink> map_links(std::span<const ChannelSnapshot::Link> links) const;

  ChannelSnapshot& snapshot_;
  double carrier_hz_ = 0.0;
  MapReceiver receiver_;
  std::vector<rf::AntennaArray> transmitters_;  ///< [transmitters of the channel]
  std::vector<MapBeams> beams_;                 ///< [transmitters of the channel]
};

/// Returns a link without paths: the gain is 0, and the means and spreads are NaN.
MapLink no_link();

}  // namespace greatx::sim
