// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "sim/channel_antennas.h"

#include <nlohmann/json.hpp>

#include "core/units.h"

namespace greatx::sim {
namespace {

rf::AntennaArray array_of(const AntennaConfig& config, double carrier_hz) {
  const double wavelength = speed_of_light / carrier_hz;
  rf::AntennaArray array;
  array.pattern =
      config.pattern == AntennaPattern::isotropic ? rf::Pattern::isotropic : rf::Pattern::half_wave_dipole;
  switch (config.polarization) {
    case Polarization::v:
      array.polarization = rf::Polarization::v;
      break;
    case Polarization::h:
      array.polarization = rf::Polarization::h;
      break;
    case Polarization::vh:
      array.polarization = rf::Polarization::vh;
      break;
    case Polarization::slant:
      array.polarization = rf::Polarization::slant;
      break;
  }
  array.rows = config.rows;
  array.columns = config.columns;
  array.row_spacing_m = config.row_spacing_wl * wavelength;
  array.column_spacing_m = config.column_spacing_wl * wavelength;
  return array;
}

}  // namespace

rf::AntennaArray antenna_array(const Scenario& scenario, const std::string& name, double carrier_hz) {
  const auto [node, sensor] = sensor_place(scenario, name);
  return array_of(std::get<AntennaConfig>(scenario.nodes[node].sensors[sensor].config), carrier_hz);
}

nlohmann::json describe_array(const rf::AntennaArray& array) {
  nlohmann::json json;
  json["pattern"] = array.pattern.shape == rf::Pattern::isotropic ? "isotropic" : "half_wave_dipole";
  constexpr const char* names[] = {"v", "h", "vh", "slant"};
  json["polarization"] = names[static_cast<uint32_t>(array.polarization)];
  json["rows"] = array.rows;
  json["columns"] = array.columns;
  json["row_spacing_m"] = array.row_spacing_m;
  json["column_spacing_m"] = array.column_spacing_m;
  json["ports"] = array.port_count();
  json["port_order"] = "(row * columns + column) * polarizations + polarization";
  return json;
}

}  // namespace greatx::sim
