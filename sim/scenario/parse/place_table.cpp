// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "sim/scenario/parse/place_table.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include <fmt/ranges.h>

#include "core/expected.h"
#include "sim/scenario/limits.h"

namespace greatx::sim {
namespace {

/// The names of a column: the short one is first.
const std::vector<std::string_view>& spellings_of(PlaceColumn column) {
  static const std::array<std::vector<std::string_view>, 7> spellings{{
      {"lat", "lat_deg", "latitude", "latitude_deg"},
      {"lon", "lon_deg", "longitude", "longitude_deg", "lng", "long"},
      {"height", "height_m", "ele", "ele_m", "elevation", "elevation_m", "alt", "alt_m", "altitude",
       "altitude_m"},
      {"t", "t_s", "time", "time_s", "timestamp", "utc"},
      {"yaw_deg"},
      {"pitch_deg"},
      {"roll_deg"},
  }};
  return spellings[static_cast<size_t>(column)];
}

std::string_view name_of(PlaceColumn column) { return spellings_of(column).front(); }

bool is_named(const CsvCell& cell, PlaceColumn column) {
  return std::ranges::find(spellings_of(column), lower_case(cell.text)) != spellings_of(column).end();
}

std::string list_of(std::span<const PlaceColumn> columns) {
  std::vector<std::string_view> names;
  for (const PlaceColumn column : columns) names.push_back(name_of(column));
  return fmt::format("{}", fmt::join(names, ", "));
}

}  // namespace

bool PlaceTable::begins(const CsvLine& line) {
  return std::ranges::any_of(line.cells, [](const CsvCell& cell) {
    return is_named(cell, PlaceColumn::latitude) || is_named(cell, PlaceColumn::longitude);
  });
}

PlaceTable::PlaceTable(const CsvLine& header, std::span<const PlaceColumn> required,
                       std::span<const PlaceColumn> optional)
    : width_(header.cells.size()) {
  std::vector<PlaceColumn> known(required.begin(), required.end());
  known.insert(known.end(), optional.begin(), optional.end());
  for (size_t i = 0; i < header.cells.size(); ++i) {
    const auto found =
        std::ranges::find_if(known, [&](PlaceColumn column) { return is_named(header.cells[i], column); });
    if (found == known.end())
      header.fail(i,
                  fmt::format("expected a column of {}, found '{}'", list_of(known), header.cells[i].text));
    std::optional<size_t>& cell = cells_[static_cast<size_t>(*found)];
    if (cell)
      header.fail(i, fmt::format("expected the column {} once, found '{}' and '{}'", name_of(*found),
                                 header.cells[*cell].text, header.cells[i].text));
    cell = i;
  }
  const auto require = [&](std::span<const PlaceColumn> columns) {
    for (const PlaceColumn column : columns)
      if (!has(column))
        header.fail(header.cells.size() - 1,
                    fmt::format("expected the columns {}, found no {}", list_of(columns), name_of(column)));
  };
  require(required);
  if (std::ranges::any_of(optional, [&](PlaceColumn column) { return has(column); })) require(optional);
}

void PlaceTable::check(const CsvLine& line) const {
  if (line.cells.size() != width_)
    line.fail(line.cells.size() - 1,
              fmt::format("expected {} values as in the header line, found {}", width_, line.cells.size()));
}

void PlaceTable::fail(const CsvLine& line, PlaceColumn column, const std::string& expected,
                      const std::string& found) const {
  line.fail(cell(column), fmt::format("{}: expected {}, found {}", name_of(column), expected, found));
}

double PlaceTable::number(const CsvLine& line, PlaceColumn column, double most) const {
  const std::string_view text = line.cells[cell(column)].text;
  const std::optional<double> value = csv_number(text);
  const std::string found = text.empty() ? "a gap" : fmt::format("'{}'", text);
  if (!value || !std::isfinite(*value)) fail(line, column, "a finite number", found);
  if (std::abs(*value) > most) fail(line, column, number_range(-most, most), found);
  return *value;
}

dvec3 PlaceTable::position(const CsvLine& line, const EarthPositions& earth) const {
  const Geodetic place{number(line, PlaceColumn::latitude, most_position_m),
                       number(line, PlaceColumn::longitude, most_position_m),
                       number(line, PlaceColumn::height, most_position_m)};
  return earth.local(place, [&](const std::string& expected, const std::string& found) {
    fail(line, PlaceColumn::latitude, expected, found);
  });
}

}  // namespace greatx::sim
