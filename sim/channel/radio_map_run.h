// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// A radio map from the request to its links, the same way for `greatx map`, Python and the benchmark:
//
//   MapRequest ─► map_bounds ─► Experiment ─► ChannelSnapshot ─► RadioMapRun ─► RadioMap
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "core/vec.h"
#include "sim/channel/radio_map.h"
#include "sim/channel/radio_map_values.h"

namespace greatx::sim {

/// A map of one channel. Its defaults need a scene, or the channel.
struct MapRequest {
  std::optional<dvec2> min_m, max_m;  ///< corners in the world; none: the scene's
  std::optional<double> cell_m;       ///< none: as map_grid_of() says
  MapHeight height;
  std::vector<double> power_dbm;       ///< one, or one a transmitter; empty: as map_power() says
  std::optional<double> bandwidth_hz;  ///< of the noise; none: the channel's
  double noise_figure_db = 0.0;
  bool inside_solids = false;  ///< cells inside solids have values, too
  bool beyond_scene = false;   ///< the map may lie outside of the scene's bounds
};

/// Checks all that needs no scene. Throws UserError like map_power().
void check_map_request(const MapRequest& request, const ChannelConfig& config);

/// Where the cells will be, for make_experiment(). Throws UserError like map_grid_of().
scene::Bounds map_bounds(const MapRequest& request, const ChannelConfig& config, const scene::Scene& scene);

class RadioMapRun {
 public:
  /// Places the cells. `snapshot` outlives this and has all transmitters of its channel; its experiment knows
  /// of the cells by map_bounds(). Throws UserError like the functions above and place_cells().
  RadioMapRun(ChannelSnapshot& snapshot, const MapRequest& request, MapReceiver receiver);

  const std::vector<dvec3>& transmitters() const { return transmitters_; }  ///< where they are, world
  const MapReceiver& receiver() const { return receiver_; }
  const MapCells& cells() const { return cells_; }
  const MapPower& power() const { return power_; }

  /// As RadioMapSolver::solve().
  void solve(size_t first, const RadioMapSolver::Take& take) { solver_.solve(cells_, first, take); }
  /// `links` are those of all cells, which solve() has handed over; they and this outlive the map.
  RadioMap map(std::span<const rf::LinkStatistics> links) const { return {&cells_, links, power_}; }

 private:
  MapReceiver receiver_;
  MapPower power_;
  std::vector<dvec3> transmitters_;
  MapCells cells_;
  RadioMapSolver solver_;
};

}  // namespace greatx::sim
