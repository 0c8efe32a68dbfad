// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// What a radio map says of its cells: one entry of map_quantities() is one array, its declaration and its
// values together.
#pragma once

#include <functional>
#include <span>
#include <string>
#include <vector>

#include "core/record.h"
#include "sim/channel/radio_map.h"

namespace greatx::sim {

/// What turns gains into received power and noise.
struct MapPower {
  std::vector<double> transmit_dbm;  ///< [tx], into one port, or spread evenly over all
  double bandwidth_hz = 0.0;
  double noise_figure_db = 0.0;
  /// Standard noise temperature T_0 (IEEE Std 100, "noise figure").
  static constexpr double temperature_k = 290.0;
  /// k T_0 B F, watts.
  double noise_w() const;
};

/// Throws UserError naming `--power`, `--bandwidth` or `--noise-figure`: powers of -200 to 200 dBm, a
/// bandwidth above 0, a noise figure of 0 dB or more.
void check_power(const MapPower& power);
inline constexpr double default_map_power_dbm = 30.0;
/// Of a channel: `transmit_dbm` one for all of its transmitters or one each; empty: the channel's, else the
/// default. No bandwidth: the channel's. Checked.
MapPower map_power(std::vector<double> transmit_dbm, std::optional<double> bandwidth_hz,
                   double noise_figure_db, const ChannelConfig& config);

/// One cell.
struct MapCell {
  std::span<const rf::LinkStatistics> links;  ///< [tx]
  std::span<const double> received_w;         ///< [tx]
  double noise_w = 0.0;
};
/// The transmitter with the highest received power, the first of equals; -1: there is no path.
int best_server(std::span<const double> received_w);

struct MapQuantity {
  std::string name, unit, description;
  DType dtype = DType::f64;
  bool per_transmitter = true;
  std::function<double(const MapCell&, size_t transmitter)> value;
  double without_value = 0.0;  ///< of cells that have none
};
const std::vector<MapQuantity>& map_quantities();
/// Throws UserError naming `--quantities` and those that there are.
const MapQuantity& map_quantity(const std::string& name);

/// A map: `links` [cells, tx].
struct RadioMap {
  const MapCells* cells = nullptr;
  std::span<const rf::LinkStatistics> links;
  MapPower power;
  size_t transmitters() const { return power.transmit_dbm.size(); }
};
/// The cells' own arrays, [rows, columns]: world heights of their middles, and CellPlacement as u8.
Array map_heights(const MapCells& cells);
Array map_placement(const MapCells& cells);
/// [tx, rows, columns], or [rows, columns] if the quantity is not a transmitter's.
Array map_array(const RadioMap& map, const MapQuantity& quantity);
/// The same of the best server of each cell, [cells]; NaN where there is none.
std::vector<double> map_at_best_server(const RadioMap& map, const MapQuantity& quantity);

}  // namespace greatx::sim
