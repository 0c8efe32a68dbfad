// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// A finished radio map on disk: arrays, pictures, map.json.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "draw/map/draw.h"
#include "sim/channel/radio_map_values.h"

namespace greatx::apps {

/// Figures of a whole map.
struct MapTotals {
  size_t cells = 0, inside = 0, nothing_beneath = 0, without_path = 0;
  std::vector<size_t> served;        ///< [tx] cells whose best server it is
  double median_path_gain_db = 0.0;  ///< of the best server, over the cells that have one; NaN: none has
  nlohmann::ordered_json json() const;
  std::string text(const std::vector<MapMarker>& transmitters) const;
};
MapTotals map_totals(const sim::RadioMap& map);

struct MapFiles {
  std::vector<std::string> quantities;  ///< names; empty: all
  bool pictures = true;
  bool each_transmitter = false;  ///< pictures of each transmitter as well
};

/// Writes NAME.npy of each quantity, z.npy and placement.npy into the folder, NAME.png and map.png, each file
/// whole or not at all, and returns what map.json says of them.
nlohmann::ordered_json write_map_files(const std::filesystem::path& folder, const sim::RadioMap& map,
                                       const MapStage& stage, const MapFiles& files);

}  // namespace greatx::apps
