// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Parses nodes[].sensors[] of type antenna.
#include <algorithm>
#include <tuple>

#include "core/units.h"
#include "sim/scenario/parse/pattern_csv.h"
#include "sim/scenario/parse/scenario_parse.h"

namespace greatx::sim {
namespace {

constexpr uint32_t most_rows = 1024;
constexpr size_t most_elements = 4096;
constexpr double least_spacing_wl = 1e-6, most_spacing_wl = 1e6;

/// Loads a pattern. Antennas with the same file share one table.
std::shared_ptr<const rf::PatternTable> load_pattern(const Field& field, PatternFiles& loaded) {
  std::shared_ptr<const rf::PatternTable>& table = loaded[field.file()];
  if (!table) table = std::make_shared<const rf::PatternTable>(load_pattern_csv(field.file()));
  return table;
}

void parse_pattern(const FieldMap& map, AntennaConfig& antenna, PatternFiles& loaded) {
  constexpr rf::Pattern patterns[] = {rf::Pattern::isotropic, rf::Pattern::short_dipole,
                                      rf::Pattern::half_wave_dipole, rf::Pattern::tr38901};
  map.exclude("pattern", "pattern_file");
  if (const auto f = map.find("pattern"))
    antenna.pattern.shape = patterns[f->choice({"isotropic", "short_dipole", "half_wave_dipole", "tr38901"})];
  if (const auto f = map.find("pattern_file")) {
    antenna.pattern.shape = rf::Pattern::imported;
    antenna.pattern.table = load_pattern(*f, loaded);
  }
}

void parse_polarization(const FieldMap& map, AntennaConfig& antenna) {
  constexpr rf::Polarization polarizations[] = {rf::Polarization::v, rf::Polarization::h,
                                                rf::Polarization::vh, rf::Polarization::slant};
  map.exclude("polarization", "slant_deg");
  if (const auto f = map.find("polarization"))
    antenna.polarization = polarizations[f->choice({"v", "h", "vh", "slant"})];
  if (const auto f = map.find("slant_deg")) {
    antenna.polarization = rf::Polarization::single;
    antenna.single_slant = radians(f->between(-180.0, 180.0));
  }
  if (const auto f = map.find("polarization_model"))
    antenna.pattern.model =
        f->choice({"1", "2"}) == 0 ? rf::PolarizationModel::model_1 : rf::PolarizationModel::model_2;
}

void parse_elements(const Field& field, AntennaConfig& antenna) {
  const std::vector<Field> items = field.list("positions", 1);
  if (items.size() > most_elements)
    field.fail(fmt::format("at most {} elements", most_elements), fmt::format("{}", items.size()));
  for (const Field& item : items) antenna.elements_wl.push_back(item.vector3(most_spacing_wl));
  std::vector<size_t> order(items.size());
  for (size_t i = 0; i < order.size(); ++i) order[i] = i;
  const auto key = [&](size_t i) {
    const dvec3& at = antenna.elements_wl[i];
    return std::tuple(at.x, at.y, at.z, i);
  };
  std::sort(order.begin(), order.end(), [&](size_t a, size_t b) { return key(a) < key(b); });
  for (size_t i = 1; i < order.size(); ++i)
    if (antenna.elements_wl[order[i]] == antenna.elements_wl[order[i - 1]])
      items[order[i]].fail("every element in a place of its own",
                           fmt::format("that of element {}", order[i - 1]));
}

void parse_layout(const FieldMap& map, AntennaConfig& antenna) {
  constexpr rf::ArrayPlane planes[] = {rf::ArrayPlane::yz, rf::ArrayPlane::xz, rf::ArrayPlane::xy};
  for (const char* grid : {"plane", "rows", "columns", "row_spacing_wl", "column_spacing_wl"})
    map.exclude("elements_wl", grid);
  if (const auto f = map.find("elements_wl")) parse_elements(*f, antenna);
  if (const auto f = map.find("plane")) antenna.plane = planes[f->choice({"yz", "xz", "xy"})];
  if (const auto f = map.find("rows")) antenna.rows = f->integer32(1, most_rows);
  if (const auto f = map.find("columns")) antenna.columns = f->integer32(1, most_rows);
  if (const auto f = map.find("row_spacing_wl"))
    antenna.row_spacing_wl = f->positive(least_spacing_wl, most_spacing_wl);
  if (const auto f = map.find("column_spacing_wl"))
    antenna.column_spacing_wl = f->positive(least_spacing_wl, most_spacing_wl);
}

}  // namespace

const Keys antenna_keys{"pattern",    "pattern_file", "polarization", "slant_deg",      "polarization_model",
                        "plane",      "rows",         "columns",      "row_spacing_wl", "column_spacing_wl",
                        "elements_wl"};

AntennaConfig parse_antenna(const FieldMap& map, PatternFiles& loaded) {
  AntennaConfig antenna;
  parse_pattern(map, antenna, loaded);
  parse_polarization(map, antenna);
  parse_layout(map, antenna);
  return antenna;
}

}  // namespace greatx::sim
