// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Measures a radio map of a square around the middle of the scene, 1.5 m above the ground.
#include <memory>
#include <utility>

#include "apps/bench/radio_rows.h"
#include "sim/channel/radio_map_run.h"
#include "sim/experiment/experiment.h"

namespace greatx::apps {

namespace {

/// Time to reach on two cores for 300 x 300 cells of 1 m and depth 3, ms. It is scaled in proportion to the
/// number of cells.
constexpr double map_target_ms = 60'000.0, map_target_cells = 90'000.0;
constexpr double cell_m = 1.0, above_ground_m = 1.5;

}  // namespace

nlohmann::json map_row(const ScenarioOptions& scenario_options, const RunOptions& run, uint32_t side_cells) {
  sim::Scenario scenario = radio_only(scenario_options, tick_rows[0]);
  scenario.channels[0].transmitters.resize(1);
  auto world = std::make_shared<const sim::World>(sim::load_world(scenario));
  const dvec3 center = world->scene.bounds.center() + world->scene.origin;
  const dvec2 half(0.5 * side_cells * cell_m);
  sim::MapRequest request;
  request.min_m = dvec2(center) - half;
  request.max_m = dvec2(center) + half;
  request.cell_m = cell_m;
  request.height = {std::nullopt, above_ground_m, sim::MapOver::ground};
  request.beyond_scene = true;
  const scene::Bounds points = sim::map_bounds(request, scenario.channels[0], world->scene);
  const sim::Experiment experiment = sim::make_experiment(std::move(scenario), std::move(world), points);
  gpu::Device device(run.device_options());
  sim::ChannelSnapshot snapshot(device, experiment, 0, {});
  // Runs the search, or reads it from the cache.
  snapshot.solve(std::span(&center, 1), 0, [](sim::ChannelSnapshot::Link) { return false; });

  const Clock::time_point begin = Clock::now();
  sim::RadioMapRun map(snapshot, request, {});
  size_t solved = 0;
  for (size_t cell = 0; cell < map.cells().grid.cells(); ++cell) solved += map.cells().solved(cell);
  uint64_t paths = 0;
  map.solve(0, [&](std::span<const sim::MapLink> links) {
    for (const sim::MapLink& link : links) paths += link.paths;
    return true;
  });
  nlohmann::json row{{"ms", milliseconds_since(begin)},
                     {"cells", map.cells().grid.cells()},
                     {"solved", solved},
                     {"paths", paths}};
  check_validation(device);
  set_target(row, map_target_ms * static_cast<double>(map.cells().grid.cells()) / map_target_cells,
             row["ms"]);
  return row;
}

}  // namespace greatx::apps
