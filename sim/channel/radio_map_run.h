// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Makes a radio map from a request, in the same way for `greatx map`, Python and the benchmark:
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

/// Describes a requested map of one channel. Values that are not given depend on the scene or the channel.
struct MapRequest {
  std::optional<dvec2> min_m, max_m;  ///< corners in the world; none: the scene's
  std::optional<double> cell_m;       ///< none: map_grid_of() chooses
  MapHeight height;
  /// One power for all transmitters, or one for each; empty: map_power() chooses.
  std::vector<double> power_dbm;
  std::optional<double> bandwidth_hz;  ///< noise bandwidth; none: that of the channel
  double noise_figure_db = 0.0;
  MapPrecoder precoder;
  bool inside_solids = false;  ///< cells inside solids have values, too
  bool beyond_scene = false;   ///< the map may extend outside the scene's bounds
};

/// Checks everything that needs no scene. Throws UserError like map_power() and check_map_precoder().
void check_map_request(const MapRequest& request, const ChannelConfig& config);

/// Returns the box of the cells for make_experiment(). Throws UserError like map_grid_of().
scene::Bounds map_bounds(const MapRequest& request, const ChannelConfig& config, const scene::Scene& scene);

/// Makes one map on a snapshot.
class RadioMapRun {
 public:
  /// Places the cells. `snapshot` outlives this and has all transmitters of its channel. Its experiment was
  /// made with map_bounds() as `points`. Throws UserError like the functions above,
  /// place_cells() and MapBeams.
  RadioMapRun(ChannelSnapshot& snapshot, const MapRequest& request, MapReceiver receiver);

  const std::vector<dvec3>& transmitters() const { return transmitters_; }  ///< world positions
  const MapReceiver& receiver() const { return receiver_; }
  const MapCells& cells() const { return cells_; }
  const MapPower& power() const { return power_; }
  MapPrecoding precoding() const { return precoding_; }

  /// Solves the links like RadioMapSolver::solve().
  void solve(size_t first, const RadioMapSolver::Take& take) { solver_.solve(cells_, first, take); }
  /// Returns the map. `links` are the links of all cells that solve() has handed over. They and this outlive
  /// the map.
  RadioMap map(std::span<const MapLink> links) const { return {&cells_, links, power_, precoding_}; }

 private:
  MapReceiver receiver_;
  MapPower power_;
  MapPrecoding precoding_;
  std::vector<dvec3> transmitters_;
  MapCells cells_;
  RadioMapSolver solver_;
};

}  // namespace greatx::sim
