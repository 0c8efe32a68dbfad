// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "sim/channel/radio_map_values.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include <fmt/ranges.h>

#include "core/text.h"
#include "core/units.h"
#include "rf/channel/received.h"

namespace greatx::sim {

namespace {

constexpr double no_value = std::numeric_limits<double>::quiet_NaN();
constexpr double boltzmann_j_k = 1.380649e-23;  ///< exact (SI Brochure, 9th edition)

/// Returns the power of one transmitter over the sum of what all others send elsewhere and the noise.
double sinr(const MapCell& cell, size_t transmitter) {
  double others = cell.noise_w;
  for (size_t t = 0; t < cell.received_w.size(); ++t)
    if (t != transmitter) others += cell.interfering_w[t];
  return cell.received_w[transmitter] / others;
}

MapQuantity statistic(std::string name, std::string unit, std::string description,
                      double rf::LinkStatistics::*member) {
  return {std::move(name),
          std::move(unit),
          std::move(description),
          DType::f64,
          true,
          [member](const MapCell& cell, size_t t) { return cell.links[t].*member; },
          no_value};
}

std::vector<MapQuantity> all_quantities() {
  using S = rf::LinkStatistics;
  const std::string circular = " spread, circular (3GPP TR 38.901, eq. A-1); NaN: no path";
  return {
      statistic("path_gain", "1",
                "sum of the paths' powers, mean over all pairs of ports, over the power sent; 0: no path",
                &S::path_gain),
      {"rss", "dBm",
       "received power: the transmitter's + 10 log10 path_gain (beam_gain with a precoder); -inf: no path",
       DType::f64, true, [](const MapCell& cell, size_t t) { return rf::dbm(cell.received_w[t]); }, no_value},
      {"sinr", "dB",
       "received power over the sum of the other transmitters' and the noise, if this one serves; -inf: no "
       "path",
       DType::f64, true, [](const MapCell& cell, size_t t) { return decibels(sinr(cell, t)); }, no_value},
      {"best_server", "1", "transmitter with the highest rss, the first of equals; -1: no path", DType::i32,
       false, [](const MapCell& cell, size_t) { return best_server(cell.received_w); }, -1.0},
      statistic("mean_delay", "s", "mean of the paths' absolute delays, weighted by power; NaN: no path",
                &S::mean_delay_s),
      statistic("delay_spread", "s", "rms, weighted by power; NaN: no path", &S::delay_spread_s),
      statistic("departure_azimuth_spread", "rad", "azimuth" + circular, &S::departure_azimuth_spread),
      statistic("departure_zenith_spread", "rad", "zenith" + circular, &S::departure_zenith_spread),
      statistic("arrival_azimuth_spread", "rad", "azimuth" + circular, &S::arrival_azimuth_spread),
      statistic("arrival_zenith_spread", "rad", "zenith" + circular, &S::arrival_zenith_spread),
      statistic("k_factor", "1",
                "power of the line of sight over that of all other paths; 0: no line of sight, +inf: nothing "
                "else, NaN: no path",
                &S::k_factor),
      {"line_of_sight", "1", "1: a path without interactions is there", DType::u8, true,
       [](const MapCell& cell, size_t t) { return cell.links[t].line_of_sight ? 1.0 : 0.0; }, 0.0},
      {"paths", "1", "number of paths", DType::i32, true,
       [](const MapCell& cell, size_t t) { return static_cast<double>(cell.links[t].paths); }, 0.0},
      {"beam_gain", "1",
       "sum of the paths' powers with the precoder, mean over the receiving ports, over the power sent; 0: "
       "no "
       "path",
       DType::f64, true, [](const MapCell& cell, size_t t) { return cell.links[t].beam_gain; }, no_value,
       true},
      {"best_beam", "1", "index of the DFT beam; -1: no path, or another precoder", DType::i32, true,
       [](const MapCell& cell, size_t t) { return static_cast<double>(cell.links[t].beam); }, -1.0, true},
  };
}

/// Calls use(cell, MapCell) for the cells that have values.
template <typename Use>
void each_cell(const RadioMap& map, const Use& use) {
  const size_t transmitters = map.transmitters();
  std::vector<double> sent_w, received_w(transmitters), interfering_w(transmitters);
  for (const double power : map.power.transmit_dbm) sent_w.push_back(rf::watts(power));
  MapCell cell{{}, received_w, interfering_w, map.power.noise_w()};
  for (size_t i = 0; i < map.cells->grid.cells(); ++i) {
    if (!map.cells->solved(i)) continue;
    cell.links = map.links.subspan(i * transmitters, transmitters);
    for (size_t t = 0; t < transmitters; ++t) {
      const MapLink& link = cell.links[t];
      const bool precoded = map.precoding != MapPrecoding::mean,
                 one_beam = map.precoding == MapPrecoding::beam;
      received_w[t] = sent_w[t] * (precoded ? link.beam_gain : link.path_gain);
      // One beam is the same for everybody. Otherwise, what others send to their own receivers is no beam to
      // this cell: on the average it comes from all ports alike.
      interfering_w[t] = sent_w[t] * (one_beam ? link.beam_gain : link.path_gain);
    }
    use(i, cell);
  }
}

template <typename T>
Array array_as(const std::vector<double>& values, const std::vector<int64_t>& shape) {
  const std::vector<T> converted(values.begin(), values.end());
  return Array::of<T>(shape, converted);
}

}  // namespace

double MapPower::noise_w() const {
  return boltzmann_j_k * temperature_k * bandwidth_hz * from_decibels(noise_figure_db);
}

void check_power(const MapPower& power) {
  for (const double dbm : power.transmit_dbm)
    if (!(std::abs(dbm) <= 200.0)) throw_user_error("--power: expected -200 to 200 dBm, found {}", dbm);
  if (!(power.bandwidth_hz > 0.0) || !std::isfinite(power.bandwidth_hz))
    throw_user_error("--bandwidth: expected more than 0 Hz, found {}", power.bandwidth_hz);
  if (!(power.noise_figure_db >= 0.0) || !std::isfinite(power.noise_figure_db))
    throw_user_error("--noise-figure: expected 0 dB or more, found {}", power.noise_figure_db);
}

MapPower map_power(std::vector<double> transmit_dbm, std::optional<double> bandwidth_hz,
                   double noise_figure_db, const ChannelConfig& config) {
  const size_t transmitters = config.transmitters.size();
  if (transmit_dbm.empty()) transmit_dbm = {config.power_dbm.value_or(default_map_power_dbm)};
  if (transmit_dbm.size() == 1) transmit_dbm.assign(transmitters, transmit_dbm[0]);
  if (transmit_dbm.size() != transmitters)
    throw_user_error("--power: expected 1 number, or {}, one a transmitter of channel '{}', found {}",
                     transmitters, config.name, transmit_dbm.size());
  MapPower power{std::move(transmit_dbm),
                 bandwidth_hz.value_or(config.subcarriers * config.subcarrier_spacing_hz), noise_figure_db};
  check_power(power);
  return power;
}

int best_server(std::span<const double> received_w) {
  const auto best = std::max_element(received_w.begin(), received_w.end());
  return best == received_w.end() || !(*best > 0.0) ? -1 : static_cast<int>(best - received_w.begin());
}

const std::vector<MapQuantity>& map_quantities() {
  static const std::vector<MapQuantity> all = all_quantities();
  return all;
}

std::vector<const MapQuantity*> map_quantities_of(MapPrecoding precoding) {
  std::vector<const MapQuantity*> quantities;
  for (const MapQuantity& quantity : map_quantities())
    if (!quantity.precoded || precoding != MapPrecoding::mean) quantities.push_back(&quantity);
  return quantities;
}

const MapQuantity& map_quantity(const std::string& name) {
  std::vector<std::string> names;
  for (const MapQuantity& quantity : map_quantities()) {
    if (quantity.name == name) return quantity;
    names.push_back(quantity.name);
  }
  throw_user_error("--quantities: expected some of {}, found '{}'{}", fmt::join(names, ", "), name,
                   suggestion(name, names));
}

Array map_heights(const MapCells& cells) {
  return Array::of<double>({cells.grid.rows, cells.grid.columns}, cells.z_m);
}

Array map_placement(const MapCells& cells) {
  std::vector<uint8_t> values;
  values.reserve(cells.placement.size());
  for (const CellPlacement placement : cells.placement) values.push_back(static_cast<uint8_t>(placement));
  return Array::of<uint8_t>({cells.grid.rows, cells.grid.columns}, values);
}

Array map_array(const RadioMap& map, const MapQuantity& quantity) {
  const size_t cells = map.cells->grid.cells(), count = quantity.per_transmitter ? map.transmitters() : 1;
  std::vector<double> values(count * cells, quantity.without_value);
  each_cell(map, [&](size_t cell, const MapCell& facts) {
    for (size_t t = 0; t < count; ++t) values[t * cells + cell] = quantity.value(facts, t);
  });
  std::vector<int64_t> shape{map.cells->grid.rows, map.cells->grid.columns};
  if (quantity.per_transmitter) shape.insert(shape.begin(), static_cast<int64_t>(count));
  switch (quantity.dtype) {
    case DType::f64:
      return Array::of<double>(shape, values);
    case DType::i32:
      return array_as<int32_t>(values, shape);
    case DType::u8:
      return array_as<uint8_t>(values, shape);
    default:
      throw ContractError(fmt::format("a map of {}", numpy_name(quantity.dtype)));
  }
}

std::vector<double> map_at_best_server(const RadioMap& map, const MapQuantity& quantity) {
  std::vector<double> values(map.cells->grid.cells(), no_value);
  each_cell(map, [&](size_t cell, const MapCell& facts) {
    const int server = best_server(facts.received_w);
    if (server >= 0) values[cell] = quantity.value(facts, static_cast<size_t>(server));
  });
  return values;
}

}  // namespace greatx::sim
