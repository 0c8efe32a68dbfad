// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// The size of the cells as a knob of a radio map. A scenario does not write it, so it is no change of the
// text; but it is measured in turns and reported like the knobs of knob.h:
//
//   Experiment ─► plan_map_study() ─► MapStudy ─► map_knob(), measure_maps()
#pragma once

#include <functional>
#include <optional>
#include <vector>

#include "gpu/device.h"
#include "sim/channel/radio_map_run.h"
#include "sim/tradeoff/knob.h"
#include "sim/tradeoff/measure.h"

namespace greatx::sim {

/// Maps of one area with cells of several sizes, of the scenario's first channel at tick 0.
struct MapStudy {
  MapRequest request;              ///< the corners of the area; its cell_m is not used
  std::vector<double> cells_m;     ///< descending; the last one is the reference
  std::optional<size_t> standard;  ///< index of the size that `greatx map` takes for the whole scene
  uint32_t turns = 3;              ///< how often each map is computed and timed
  std::string skipped;             ///< why there is no area; empty: there is one
};

/// Plans maps around the middle of the scene. Sizes are eight times to half of what `greatx map` takes for
/// the whole scene; `quick` leaves out the half. All grids cover the same area: six by six of the largest
/// cells for one transmitter, fewer for more of them, and not more than the scene has (but at least one).
MapStudy plan_map_study(const Experiment& experiment, bool quick);

/// Describes the study as a knob; its settings have no changes.
Knob map_knob(const MapStudy& study);

/// Computes the maps in turns, after one of the largest cells to warm up. The receiver of every cell is one
/// isotropic element. A result has `path_gain` as its record, f64 [tx, rows, columns], of kind "map"; errors
/// compare the centres of the finest cells. The search of paths is common to all maps; start_ms has its time.
/// Returns nothing if `go_on` returned false. Throws UserError like RadioMapRun.
std::vector<SettingResult> measure_maps(gpu::Device& device, const Experiment& experiment,
                                        const MapStudy& study, const std::function<bool()>& go_on);

}  // namespace greatx::sim
