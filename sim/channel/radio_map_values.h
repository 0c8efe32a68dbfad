// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Computes the quantities of a radio map. One entry of map_quantities() is one array; its declaration and its
// values stand together.
#pragma once

#include <functional>
#include <span>
#include <string>
#include <vector>

#include "core/record.h"
#include "sim/channel/radio_map.h"

namespace greatx::sim {

/// Holds the values that convert gains to received power and noise.
struct MapPower {
  std::vector<double> transmit_dbm;  ///< [tx] into one port, or spread evenly over all ports
  double bandwidth_hz = 0.0;
  double noise_figure_db = 0.0;
  /// Standard noise temperature T_0 (IEEE Std 100, "noise figure").
  static constexpr double temperature_k = 290.0;
  /// Returns the noise power k T_0 B F, watts.
  double noise_w() const;
};

/// Throws UserError naming `--power`, `--bandwidth` or `--noise-figure` unless powers are -200 to 200 dBm,
/// the bandwidth is above 0, and the noise figure is 0 dB or more.
void check_power(const MapPower& power);
inline constexpr double default_map_power_dbm = 30.0;
/// Returns the powers of a channel. `transmit_dbm` has one value for all transmitters or one for each. If it
/// is empty, the power is that of the channel, or the default if the channel has none. The bandwidth is that
/// of the channel if it is not given. Throws UserError like check_power(), and for a wrong number of powers.
MapPower map_power(std::vector<double> transmit_dbm, std::optional<double> bandwidth_hz,
                   double noise_figure_db, const ChannelConfig& config);

/// Holds the links of one cell.
struct MapCell {
  std::span<const MapLink> links;         ///< [tx]
  std::span<const double> received_w;     ///< [tx] if this transmitter serves: with its precoder
  std::span<const double> interfering_w;  ///< [tx] if another one serves
  double noise_w = 0.0;
};
/// Returns the transmitter with the highest received power, the first of equals; -1: there is no path.
int best_server(std::span<const double> received_w);

/// Describes a quantity and how to compute it.
struct MapQuantity {
  std::string name, unit, description;
  DType dtype = DType::f64;
  bool per_transmitter = true;
  std::function<double(const MapCell&, size_t transmitter)> value;
  double without_value = 0.0;  ///< the value of cells without values
  bool precoded = false;       ///< says nothing in a map without a precoder
};
/// Returns all quantities.
const std::vector<MapQuantity>& map_quantities();
/// Returns those that a map with such a precoder has.
std::vector<const MapQuantity*> map_quantities_of(MapPrecoding precoding);
/// Returns the quantity of a name. Throws UserError naming `--quantities` and all quantities if there is
/// none.
const MapQuantity& map_quantity(const std::string& name);

/// Holds a map; `links` is [cells, tx].
struct RadioMap {
  const MapCells* cells = nullptr;
  std::span<const MapLink> links;
  MapPower power;
  MapPrecoding precoding = MapPrecoding::mean;
  size_t transmitters() const { return power.transmit_dbm.size(); }
};
/// Return the arrays of the cells, [rows, columns]: the world heights of their centres, and their
/// CellPlacement as u8.
Array map_heights(const MapCells& cells);
Array map_placement(const MapCells& cells);
/// Returns a quantity as [tx, rows, columns], or [rows, columns] if it does not depend on the transmitter.
Array map_array(const RadioMap& map, const MapQuantity& quantity);
/// Returns a quantity for the best server of each cell, [cells]; NaN where there is none.
std::vector<double> map_at_best_server(const RadioMap& map, const MapQuantity& quantity);

}  // namespace greatx::sim
