// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "view/overlay/antenna_metadata.h"

#include <algorithm>
#include <array>
#include <optional>
#include <string_view>
#include <vector>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "core/text.h"
#include "core/units.h"
#include "view/overlay/json_values.h"

namespace greatx::view {

namespace {

using io::JsonValue;

constexpr size_t most_elements = 1 << 20;
constexpr double widest_m = 1e6;
constexpr std::array<std::string_view, 5> patterns{"isotropic", "short_dipole", "half_wave_dipole", "tr38901",
                                                   "imported"};
constexpr std::array<std::string_view, 5> polarizations{"v", "h", "vh", "slant", "single"};
constexpr std::array<std::string_view, 3> planes{"yz", "xz", "xy"};

/// The place of the value among `names`.
template <size_t count>
uint32_t choice(const JsonValue& json, const std::array<std::string_view, count>& names) {
  const std::string text = json.text();
  const auto found = std::ranges::find(names, text);
  if (found == names.end()) json.fail(fmt::format("one of {}", fmt::join(names, ", ")));
  return static_cast<uint32_t>(found - names.begin());
}

/// Numbers between single spaces, as many as `count`; zeros if the text is not there.
std::vector<double> numbers_of(const JsonValue& table, const char* key, size_t count) {
  std::vector<double> values;
  if (!table.has(key)) {
    values.resize(count);
    return values;
  }
  const JsonValue json = table.at(key);
  const std::string text = json.text();
  values.reserve(count);
  for (size_t begin = 0; begin <= text.size();) {
    const size_t end = std::min(text.find(' ', begin), text.size());
    const std::optional<double> value = parse_number(std::string_view(text).substr(begin, end - begin));
    if (!value || std::abs(*value) > 1e9 || values.size() == count)
      json.fail(fmt::format("{} numbers from -1e9 to 1e9", count));
    values.push_back(*value);
    begin = end + 1;
  }
  if (values.size() != count) json.fail(fmt::format("{} numbers", count));
  return values;
}

void read_layout(const JsonValue& json, rf::AntennaArray& array) {
  if (json.has("elements_m")) {
    for (const JsonValue& at : json.at("elements_m").list(most_elements))
      array.positions_m.push_back(vector_of(at));
    if (array.positions_m.empty()) json.at("elements_m").fail("one element or more");
    return;
  }
  if (!json.has("rows")) return;
  array.plane = static_cast<rf::ArrayPlane>(choice(json.at("plane"), planes));
  array.rows = static_cast<uint32_t>(json.at("rows").integer(1, 1 << 16));
  array.columns = static_cast<uint32_t>(json.at("columns").integer(1, most_elements / array.rows));
  array.row_spacing_m = json.at("row_spacing_m").number(-widest_m, widest_m);
  array.column_spacing_m = json.at("column_spacing_m").number(-widest_m, widest_m);
}

}  // namespace

std::shared_ptr<const rf::PatternTable> PatternTables::table(const JsonValue& sha256) {
  const std::string name = sha256.text();
  if (const auto found = parsed_.find(name); found != parsed_.end()) return found->second;
  if (!channel_.has("pattern_tables") || !channel_.at("pattern_tables").has(name))
    sha256.fail("one of pattern_tables");
  const JsonValue json = channel_.at("pattern_tables").at(name);
  rf::PatternTable::Grid grid;
  grid.zeniths = static_cast<uint32_t>(json.at("zeniths").integer(3, 1 << 12));
  grid.azimuths = static_cast<uint32_t>(json.at("azimuths").integer(4, 1 << 12));
  grid.first_azimuth = radians(json.at("first_azimuth_deg").number(-720.0, 720.0));
  const size_t count = size_t{grid.zeniths} * grid.azimuths;
  const std::vector<double> theta_re = numbers_of(json, "f_theta_re", count),
                            theta_im = numbers_of(json, "f_theta_im", count),
                            phi_re = numbers_of(json, "f_phi_re", count),
                            phi_im = numbers_of(json, "f_phi_im", count);
  std::vector<rf::Jones> samples(count);
  for (size_t i = 0; i < count; ++i) samples[i] = {{theta_re[i], theta_im[i]}, {phi_re[i], phi_im[i]}};
  const auto table = std::make_shared<const rf::PatternTable>(
      grid, std::move(samples), json.has("file") ? json.at("file").text() : std::string(), name);
  parsed_.emplace(name, table);
  return table;
}

AntennaFacts antenna_of(const JsonValue& json, PatternTables& tables) {
  AntennaFacts antenna;
  if (json.has("pattern")) {
    antenna.array.pattern.shape = static_cast<rf::Pattern>(choice(json.at("pattern"), patterns));
    antenna.pattern = json.at("pattern").text();
    if (antenna.array.pattern.shape == rf::Pattern::imported)
      antenna.array.pattern.table = tables.table(json.at("pattern_table"));
  }
  if (json.has("polarization")) {
    antenna.array.polarization =
        static_cast<rf::Polarization>(choice(json.at("polarization"), polarizations));
    antenna.polarization = json.at("polarization").text();
  }
  if (json.has("polarization_model"))
    antenna.array.pattern.model =
        static_cast<rf::PolarizationModel>(json.at("polarization_model").integer(1, 2));
  if (antenna.array.polarization == rf::Polarization::single && json.has("slants_deg"))
    antenna.array.single_slant = radians(json.at("slants_deg").tuple(1)[0].number(-360.0, 360.0));
  read_layout(json, antenna.array);
  return antenna;
}

}  // namespace greatx::view
