// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Parses nodes[].sensors[] of type antenna.
#include <algorithm>
#include <tuple>

#include "core/units.h"
#include "sim/scenario/parse/scenario_parse.h"

namespace greatx::sim {
namespace {

constexpr uint32_t most_rows = 1024;
constexpr size_t most_elements = 4096;
constexpr double least_spacing_wl = 1e-6, most_spacing_wl = 1e6;

/// Returns what the keys say about a pattern file. Each key belongs to one format.
PatternOptions parse_pattern_options(const FieldMap& map, PatternFormat format) {
  const auto find = [&](const char* key, PatternFormat only, const char* files) {
    const auto f = map.find(key);
    if (f && format != only)
      f->fail(fmt::format("'{}' with a pattern_file {} alone", key, files), "another one");
    return f;
  };
  PatternOptions options;
  if (const auto f = find("pattern_frequency_hz", PatternFormat::ffd, ".ffd"))
    options.frequency_hz = f->positive(1e6, 1e13);
  if (const auto f = find("pattern_power_w", PatternFormat::ffd, ".ffd"))
    options.power_w = f->positive(1e-12, 1e12);
  if (const auto f = find("pattern_vertical", PatternFormat::msi, ".msi or .pln"))
    options.vertical_up = f->choice({"down", "up"}) == 1;
  return options;
}

/// Loads a pattern. Antennas with the same file and the same options share one table.
std::shared_ptr<const rf::PatternTable> load_pattern(const FieldMap& map, const Field& field,
                                                     PatternFiles& loaded) {
  const PatternOptions options = parse_pattern_options(map, pattern_format(field.file()));
  std::shared_ptr<const rf::PatternTable>& table = loaded[{field.file(), options}];
  if (table) return table;
  try {
    table = std::make_shared<const rf::PatternTable>(load_pattern_file(field.file(), options));
  } catch (const PatternOptionError& error) {
    if (const auto option = map.find(error.key)) option->fail(error.expected, error.found);
    field.fail(fmt::format("'{}' beside it: {}", error.key, error.expected), error.found);
  }
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
    antenna.pattern.table = load_pattern(map, *f, loaded);
  } else {
    for (const char* key : {"pattern_frequency_hz", "pattern_power_w", "pattern_vertical"})
      if (const auto option = map.find(key)) option->fail("'pattern_file' beside it", "none");
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

const Keys antenna_keys{
    "pattern",      "pattern_file",   "pattern_frequency_hz", "pattern_power_w", "pattern_vertical",
    "polarization", "slant_deg",      "polarization_model",   "plane",           "rows",
    "columns",      "row_spacing_wl", "column_spacing_wl",    "elements_wl"};

AntennaConfig parse_antenna(const FieldMap& map, PatternFiles& loaded) {
  AntennaConfig antenna;
  parse_pattern(map, antenna, loaded);
  parse_polarization(map, antenna);
  parse_layout(map, antenna);
  return antenna;
}

}  // namespace greatx::sim
