// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "sim/channel/radio_map.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/parallel.h"
#include "rf/facets/placement.h"
#include "sim/plan/antennas.h"

namespace greatx::sim {

namespace {

constexpr double no_ground = std::numeric_limits<double>::quiet_NaN();

/// Returns a round cell size for a map of this extent.
double default_cell(double extent_m) {
  constexpr double most_cells = 150.0;
  if (!(extent_m > 0.0)) return 1.0;
  const double least = extent_m / most_cells, decade = std::pow(10.0, std::floor(std::log10(least)));
  for (const double step : {1.0, 2.0, 5.0})
    if (step * decade >= least) return step * decade;
  return 10.0 * decade;
}

bool finite(const dvec2& v) { return std::isfinite(v.x) && std::isfinite(v.y); }

scene::Bounds world_bounds(const scene::Scene& scene) {
  scene::Bounds bounds = scene.bounds;
  bounds.min += scene.origin;
  bounds.max += scene.origin;
  return bounds;
}

void check_rectangle(const MapGrid& grid, const scene::Bounds& bounds) {
  const dvec2 max = grid.max_m();
  if (grid.min_m.x < bounds.max.x && max.x > bounds.min.x && grid.min_m.y < bounds.max.y &&
      max.y > bounds.min.y)
    return;
  throw_user_error(
      "--min, --max: expected a rectangle that meets the scene, x {:.6g} to {:.6g} m and y {:.6g} to {:.6g} "
      "m, found x {:.6g} to {:.6g} m and y {:.6g} to {:.6g} m (--beyond-scene maps what is outside)",
      bounds.min.x, bounds.max.x, bounds.min.y, bounds.max.y, grid.min_m.x, max.x, grid.min_m.y, max.y);
}

void check_plane(double z, scene::Bounds bounds, std::span<const dvec3> ends) {
  for (const dvec3& end : ends) bounds.add(end);
  if (z >= bounds.min.z && z <= bounds.max.z) return;
  throw_user_error(
      "--plane: expected a height within the scene and its transmitters, z {:.6g} to {:.6g} m, found {:.6g} "
      "m (--beyond-scene maps what is outside)",
      bounds.min.z, bounds.max.z, z);
}

/// Returns the world z of every cell, and sets `rule`.
std::vector<double> heights(const MapGrid& grid, const MapHeight& height, const scene::Scene& scene,
                            std::string& rule) {
  std::vector<double> z(grid.cells(), no_ground);
  if (height.plane_z_m) {
    rule = fmt::format("{:.17g} m, a plane of the world", *height.plane_z_m);
    std::fill(z.begin(), z.end(), *height.plane_z_m);
    return z;
  }
  const GroundHeights ground(scene, height.over);
  rule = fmt::format("{:.17g} m above {}", height.above_m, ground.rule());
  parallel_for(grid.rows, 0, [&](size_t row) {
    for (size_t cell = row * grid.columns; cell < (row + 1) * grid.columns; ++cell)
      if (const auto beneath = ground.at(grid.center(cell))) z[cell] = *beneath + height.above_m;
  });
  if (std::all_of(z.begin(), z.end(), [](double value) { return std::isnan(value); }))
    throw_user_error(
        "--height: expected {} beneath some of the cells, found it beneath none; --plane Z maps "
        "at one height",
        ground.rule());
  return z;
}

CellPlacement placement_of(const rf::Placement& placement) {
  if (placement.solid != rf::Placement::none) return CellPlacement::solid;
  if (placement.surface != rf::Placement::none) return CellPlacement::on_surface;
  if (placement.beneath != rf::Placement::none) return CellPlacement::beneath;
  return placement.foliage != rf::Placement::none ? CellPlacement::foliage : CellPlacement::free;
}

}  // namespace

MapGrid map_grid_of(const std::optional<dvec2>& min_m, const std::optional<dvec2>& max_m,
                    std::optional<double> cell_m, const scene::Scene& scene, size_t transmitters) {
  if (scene.bounds.empty() && !(min_m && max_m))
    throw_user_error("--min, --max: expected where the map is, as the scene is empty, found none");
  const dvec2 min = min_m ? *min_m : dvec2(scene.bounds.min + scene.origin),
              max = max_m ? *max_m : dvec2(scene.bounds.max + scene.origin);
  return make_map_grid(min, max, cell_m ? *cell_m : default_cell(std::max(max.x - min.x, max.y - min.y)),
                       transmitters);
}

MapGrid make_map_grid(const dvec2& min_m, const dvec2& max_m, double cell_m, size_t transmitters) {
  if (!(cell_m > 0.0) || !std::isfinite(cell_m))
    throw_user_error("--cell: expected a length above 0 m, found {}", cell_m);
  if (!finite(min_m)) throw_user_error("--min: expected finite coordinates, found {} {}", min_m.x, min_m.y);
  if (!finite(max_m)) throw_user_error("--max: expected finite coordinates, found {} {}", max_m.x, max_m.y);
  if (!(max_m.x > min_m.x && max_m.y > min_m.y))
    throw_user_error("--max: expected more than --min ({} {}) along x and y, found {} {}", min_m.x, min_m.y,
                     max_m.x, max_m.y);
  // The factor absorbs rounding: a side of 300 m has 3000 cells of 0.1 m, although 0.1 is not exact in
  // binary.
  const dvec2 count = glm::ceil((max_m - min_m) / cell_m * (1.0 - 1e-12));
  if (count.x * count.y * static_cast<double>(transmitters) > static_cast<double>(most_map_links))
    throw_user_error(
        "--cell: expected {} cells times transmitters or fewer, found {:.0f} x {:.0f} cells and "
        "{} transmitters",
        most_map_links, count.x, count.y, transmitters);
  return {min_m, cell_m, static_cast<uint32_t>(count.x), static_cast<uint32_t>(count.y)};
}

scene::Bounds bounds_of_cells(const MapGrid& grid, const MapHeight& height, const scene::Scene& scene) {
  const scene::Bounds world = world_bounds(scene);
  const double least = height.plane_z_m.value_or(world.min.z + height.above_m),
               most = height.plane_z_m.value_or(world.max.z + height.above_m);
  scene::Bounds bounds;
  if (!height.plane_z_m && world.empty()) return bounds;  // there will be no cell
  bounds.add({grid.center(0), least});
  bounds.add({grid.center(grid.cells() - 1), most});
  return bounds;
}

MapCells place_cells(const MapGrid& grid, const MapHeight& height, const scene::Scene& scene,
                     const rf::FacetKinds& kinds, std::span<const Pose> bodies, std::span<const dvec3> ends,
                     bool beyond_scene) {
  const scene::Bounds bounds = world_bounds(scene);
  if (height.plane_z_m && !std::isfinite(*height.plane_z_m))
    throw_user_error("--plane: expected a finite height, found {}", *height.plane_z_m);
  if (!(height.above_m > 0.0) || !std::isfinite(height.above_m))
    throw_user_error("--height: expected more than 0 m, found {}", height.above_m);
  if (!beyond_scene) {
    check_rectangle(grid, bounds);
    if (height.plane_z_m) check_plane(*height.plane_z_m, bounds, ends);
  }
  MapCells cells;
  cells.grid = grid;
  cells.z_m = heights(grid, height, scene, cells.height_rule);
  cells.placement.resize(grid.cells(), CellPlacement::nothing_beneath);
  const rf::Surroundings surroundings(scene, kinds);
  parallel_for(grid.rows, 0, [&](size_t row) {
    for (size_t cell = row * grid.columns; cell < (row + 1) * grid.columns; ++cell)
      if (!std::isnan(cells.z_m[cell]))
        cells.placement[cell] = placement_of(surroundings.of(scene.to_local(cells.point(cell)), bodies));
  });
  return cells;
}

MapLink no_link() { return {rf::link_statistics({}, {})}; }

RadioMapSolver::RadioMapSolver(ChannelSnapshot& snapshot, MapReceiver receiver, const MapPrecoder& precoder)
    : snapshot_(snapshot), receiver_(std::move(receiver)) {
  const Scenario& scenario = snapshot.experiment().scenario;
  const ChannelConfig& config = scenario.channels[snapshot.channel()];
  carrier_hz_ = config.carrier_hz;
  for (const std::string& name : config.transmitters) {
    transmitters_.push_back(antenna_array(scenario, name, carrier_hz_));
    beams_.emplace_back(precoder, transmitters_.back(), name);
  }
}

std::vector<MapLink> RadioMapSolver::map_links(std::span<const ChannelSnapshot::Link> links) const {
  std::vector<MapLink> result(links.size());
  parallel_for(links.size(), 0, [&](size_t i) {
    const ChannelSnapshot::Link& link = links[i];
    const rf::ArrayPose transmitter{transmitters_[link.transmitter], link.transmitter_state.orientation};
    const rf::ArrayPose receiver{receiver_.array, receiver_.orientation};
    result[i] = beams_[link.transmitter].link(link.paths, transmitter, receiver, carrier_hz_);
  });
  return result;
}

void RadioMapSolver::solve(const MapCells& cells, size_t first, const Take& take) {
  const size_t transmitters = snapshot_.transmitters();
  std::vector<dvec3> points;
  for (size_t cell = first; cell < cells.grid.cells(); ++cell)
    if (cells.solved(cell)) points.push_back(cells.point(cell));

  size_t next = first;  // the first cell that has not been handed over
  std::vector<ChannelSnapshot::Link> waiting;
  bool go_on = true;
  /// Hands over the waiting links and the cells without values between them; at the end, also those after
  /// them.
  const auto hand_over = [&](bool end) {
    const std::vector<MapLink> solved = map_links(waiting);
    waiting.clear();
    std::vector<MapLink> links;
    for (size_t used = 0; next < cells.grid.cells(); ++next) {
      const bool has_values = cells.solved(next);
      if (has_values && used == solved.size()) break;
      if (!has_values && used == solved.size() && !end) break;
      for (size_t t = 0; t < transmitters; ++t) links.push_back(has_values ? solved[used++] : no_link());
    }
    go_on = links.empty() || take(links);
  };
  const auto collect = [&](ChannelSnapshot::Link link) {
    waiting.push_back(std::move(link));
    if (waiting.size() == transmitters * ChannelSnapshot::points_at_once) hand_over(false);
    return go_on;
  };
  snapshot_.solve(points, 0, collect, false);  // place_cells() has checked the points
  if (go_on) hand_over(true);
}

}  // namespace greatx::sim
