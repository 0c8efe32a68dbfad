// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Writes a finished radio map to disk as arrays and pictures, and describes them for map.json.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "draw/map/draw.h"
#include "sim/channel/radio_map_values.h"

namespace greatx::apps {

/// Holds figures of a whole map: the number of all cells, of those inside solids, of those with nothing
/// beneath, and of those that were solved and have no path.
struct MapTotals {
  size_t cells = 0, inside = 0, nothing_beneath = 0, without_path = 0;
  std::vector<size_t> served;  ///< [tx] number of cells whose best server is this transmitter
  /// Median path gain of the best server over the cells that have one; NaN if no cell has.
  double median_path_gain_db = 0.0;
  nlohmann::ordered_json json() const;
  std::string text(const std::vector<MapMarker>& transmitters) const;
};
MapTotals map_totals(const sim::RadioMap& map);

/// Selects the files of a map.
struct MapFiles {
  std::vector<std::string> quantities;  ///< names; empty: all
  bool pictures = true;
  bool each_transmitter = false;  ///< also pictures of each transmitter
};

/// Writes into the folder NAME.npy of each quantity, z.npy and placement.npy, and with pictures NAME.png and
/// map.png. Each file is written completely or not at all. Returns the entries of map.json that describe
/// them.
nlohmann::ordered_json write_map_files(const std::filesystem::path& folder, const sim::RadioMap& map,
                                       const MapStage& stage, const MapFiles& files);

}  // namespace greatx::apps
