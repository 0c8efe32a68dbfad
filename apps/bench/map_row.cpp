// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// The row of radio maps: a square about the scene's middle, 1.5 m above the ground.
#include <memory>
#include <utility>

#include "apps/bench/radio_rows.h"
#include "sim/channel/radio_map.h"
#include "sim/experiment/experiment.h"

namespace greatx::apps {

namespace {

/// Figure to reach on two cores for 300 x 300 cells of 1 m and depth 3, ms; other sizes in proportion.
constexpr double map_target_ms = 60'000.0, map_target_cells = 90'000.0;
constexpr double cell_m = 1.0, above_ground_m = 1.5;

}  // namespace

nlohmann::json map_row(const ScenarioOptions& scenario_options, const RunOptions& run, uint32_t side_cells) {
  sim::Scenario scenario = radio_only(scenario_options, tick_rows[0]);
  auto world = std::make_shared<const sim::World>(sim::load_world(scenario));
  const scene::Scene& scene = world->scene;
  const dvec2 middle(scene.bounds.center() + scene.origin), half(0.5 * side_cells * cell_m);
  const sim::MapGrid grid = sim::make_map_grid(middle - half, middle + half, cell_m, 1);
  const sim::MapHeight height{std::nullopt, above_ground_m, sim::MapOver::ground};
  const sim::Experiment experiment =
      sim::make_experiment(std::move(scenario), world, sim::bounds_of_cells(grid, height, scene));
  gpu::Device device(run.device_options());
  sim::ChannelSnapshot snapshot(device, experiment, 0, {0, 0, 0});
  const dvec3 above = scene.bounds.center() + scene.origin;
  sim::RadioMapSolver solver(snapshot, experiment.scenario, 0, {});
  const dvec3 point(middle, above.z);
  snapshot.solve(std::span(&point, 1), 0, [](sim::ChannelSnapshot::Link) { return false; });  // the search

  const Clock::time_point begin = Clock::now();
  const sim::MapCells cells = sim::place_cells(grid, height, scene, snapshot.model().kinds,
                                               snapshot.moment().bodies, std::span(&above, 1), true);
  size_t solved = 0;
  for (size_t cell = 0; cell < grid.cells(); ++cell) solved += cells.solved(cell);
  uint64_t paths = 0;
  solver.solve(cells, 0, [&](std::span<const rf::LinkStatistics> links) {
    for (const rf::LinkStatistics& link : links) paths += link.paths;
    return true;
  });
  nlohmann::json row{
      {"ms", milliseconds_since(begin)}, {"cells", grid.cells()}, {"solved", solved}, {"paths", paths}};
  check_validation(device);
  set_target(row, map_target_ms * static_cast<double>(grid.cells()) / map_target_cells, row["ms"]);
  return row;
}

}  // namespace greatx::apps
