// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "sim/plan/antennas.h"

#include <algorithm>
#include <vector>

#include <fmt/ranges.h>
#include <nlohmann/json.hpp>

#include "core/units.h"
#include "rf/antenna/pattern_cuts.h"

namespace greatx::sim {
namespace {

void describe_layout(const rf::AntennaArray& array, nlohmann::json& json) {
  if (!array.positions_m.empty()) {
    for (const dvec3& at : array.positions_m) json["elements_m"].push_back({at.x, at.y, at.z});
    json["port_order"] = "element * polarizations + polarization";
    return;
  }
  constexpr const char* planes[] = {"yz", "xz", "xy"};
  json["plane"] = planes[static_cast<uint32_t>(array.plane)];
  json["rows"] = array.rows;
  json["columns"] = array.columns;
  json["row_spacing_m"] = array.row_spacing_m;
  json["column_spacing_m"] = array.column_spacing_m;
  json["port_order"] = "(row * columns + column) * polarizations + polarization";
}

/// Adds one part of one component, [zeniths * azimuths], unless it is zero throughout. The values are one
/// text, because dataset.json is written with one line for each item of a list, and a table has some 100,000
/// items.
void describe_part(const rf::PatternTable& table, const char* name, double (*part)(const rf::Jones&),
                   nlohmann::json& json) {
  std::vector<double> values;
  for (const rf::Jones& sample : table.samples()) values.push_back(part(sample));
  if (std::any_of(values.begin(), values.end(), [](double value) { return value != 0.0; }))
    json[name] = fmt::format("{}", fmt::join(values, " "));
}

nlohmann::json describe_table(const rf::PatternTable& table) {
  nlohmann::json json;
  json["file"] = table.name();
  json["zeniths"] = table.grid().zeniths;
  json["azimuths"] = table.grid().azimuths;
  json["first_azimuth_deg"] = degrees(table.grid().first_azimuth);
  json["mean_gain_db"] = decibels(rf::mean_gain(table));
  describe_part(
      table, "f_theta_re", [](const rf::Jones& f) { return f.theta.real(); }, json);
  describe_part(
      table, "f_theta_im", [](const rf::Jones& f) { return f.theta.imag(); }, json);
  describe_part(
      table, "f_phi_re", [](const rf::Jones& f) { return f.phi.real(); }, json);
  describe_part(
      table, "f_phi_im", [](const rf::Jones& f) { return f.phi.imag(); }, json);
  return json;
}

}  // namespace

rf::AntennaArray antenna_array(const Scenario& scenario, const std::string& name, double carrier_hz) {
  const auto [node, sensor] = sensor_place(scenario, name);
  return array_of(std::get<AntennaConfig>(scenario.nodes[node].sensors[sensor].config), carrier_hz);
}

nlohmann::json describe_array(const rf::AntennaArray& array) {
  nlohmann::json json;
  constexpr const char* patterns[] = {"isotropic", "short_dipole", "half_wave_dipole", "tr38901", "imported"};
  constexpr const char* polarizations[] = {"v", "h", "vh", "slant", "single"};
  json["pattern"] = patterns[static_cast<uint32_t>(array.pattern.shape)];
  if (array.pattern.table) {
    json["pattern_file"] = array.pattern.table->name();
    json["pattern_table"] = array.pattern.table->sha256();
  }
  json["polarization"] = polarizations[static_cast<uint32_t>(array.polarization)];
  json["polarization_model"] = static_cast<uint32_t>(array.pattern.model);
  for (uint32_t p = 0; p < array.polarization_count(); ++p)
    json["slants_deg"].push_back(degrees(array.slant(p)));
  json["ports"] = array.port_count();
  json["aperture_m"] = array.aperture();
  describe_layout(array, json);
  return json;
}

nlohmann::json describe_pattern_tables(std::initializer_list<std::span<const rf::AntennaArray>> ends) {
  nlohmann::json tables = nlohmann::json::object();
  for (const std::span<const rf::AntennaArray> arrays : ends)
    for (const rf::AntennaArray& array : arrays)
      if (array.pattern.table && !tables.contains(array.pattern.table->sha256()))
        tables[array.pattern.table->sha256()] = describe_table(*array.pattern.table);
  return tables;
}

}  // namespace greatx::sim
