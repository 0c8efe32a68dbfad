// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "sim/channel/radio_map_run.h"

#include <utility>

#include "sim/channel/ends.h"

namespace greatx::sim {

namespace {

const ChannelConfig& config_of(const ChannelSnapshot& snapshot) {
  return snapshot.experiment().scenario.channels[snapshot.channel()];
}

MapPower power_of(const MapRequest& request, const ChannelConfig& config) {
  return map_power(request.power_dbm, request.bandwidth_hz, request.noise_figure_db, config);
}

MapGrid grid_of(const MapRequest& request, const ChannelConfig& config, const scene::Scene& scene) {
  return map_grid_of(request.min_m, request.max_m, request.cell_m, scene, config.transmitters.size());
}

std::vector<dvec3> transmitters_of(const ChannelSnapshot& snapshot) {
  std::vector<dvec3> transmitters;
  for (const std::string& name : config_of(snapshot).transmitters)
    transmitters.push_back(
        world_position(antenna_end(snapshot.experiment(), name), snapshot.moment().context));
  return transmitters;
}

MapCells cells_of(const MapRequest& request, const ChannelSnapshot& snapshot,
                  std::span<const dvec3> transmitters) {
  const scene::Scene& scene = snapshot.experiment().scene();
  MapCells cells =
      place_cells(grid_of(request, config_of(snapshot), scene), request.height, scene, snapshot.model().kinds,
                  snapshot.moment().bodies, transmitters, request.beyond_scene);
  cells.solve_inside = request.inside_solids;
  return cells;
}

}  // namespace

void check_map_request(const MapRequest& request, const ChannelConfig& config) {
  power_of(request, config);
  check_map_precoder(request.precoder);
}

scene::Bounds map_bounds(const MapRequest& request, const ChannelConfig& config, const scene::Scene& scene) {
  return bounds_of_cells(grid_of(request, config, scene), request.height, scene);
}

RadioMapRun::RadioMapRun(ChannelSnapshot& snapshot, const MapRequest& request, MapReceiver receiver)
    : receiver_(std::move(receiver)),
      power_(power_of(request, config_of(snapshot))),
      precoding_(request.precoder.precoding),
      transmitters_(transmitters_of(snapshot)),
      cells_(cells_of(request, snapshot, transmitters_)),
      solver_(snapshot, receiver_, request.precoder) {}

}  // namespace greatx::sim
