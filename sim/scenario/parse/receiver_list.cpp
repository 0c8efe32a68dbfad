// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "sim/scenario/parse/receiver_list.h"

#include <array>
#include <cmath>

#include "core/expected.h"
#include "sim/scenario/limits.h"
#include "sim/scenario/parse/csv.h"
#include "sim/scenario/parse/place_table.h"

namespace greatx::sim {
namespace {

constexpr std::array<const char*, 3> receiver_columns = {"x", "y", "z"};

void check_count(const CsvLine& line) {
  if (line.cells.size() != receiver_columns.size())
    line.fail(line.cells.size() - 1, fmt::format("expected 3 values (x, y, z), found {}", line.cells.size()));
}

/// Checks the receiver_columns of a header, since one in another order would swap coordinates in silence.
void check_receiver_header(const CsvLine& line) {
  check_count(line);
  for (size_t i = 0; i < receiver_columns.size(); ++i) {
    const std::string name = lower_case(line.cells[i].text);
    if (name != receiver_columns[i] && name != std::string(receiver_columns[i]) + "_m")
      line.fail(i, fmt::format("{0}: expected a number, or '{0}' in a header line, found '{1}'",
                               receiver_columns[i], line.cells[i].text));
  }
}

dvec3 parse_position(const CsvLine& line) {
  check_count(line);
  dvec3 position(0.0);
  for (size_t i = 0; i < receiver_columns.size(); ++i) {
    const auto value = csv_number(line.cells[i].text);
    if (!value || !std::isfinite(*value))
      line.fail(i,
                fmt::format("{}: expected a finite number, found {}", receiver_columns[i],
                            line.cells[i].text.empty() ? "a gap" : fmt::format("'{}'", line.cells[i].text)));
    if (std::abs(*value) > most_position_m)
      line.fail(i, fmt::format("{}: expected {}, found '{}'", receiver_columns[i],
                               number_range(-most_position_m, most_position_m), line.cells[i].text));
    position[static_cast<int>(i)] = *value;
  }
  return position;
}

/// Parses the lines behind a header that receiver_columns places on the Earth.
std::vector<dvec3> parse_receiver_places(const CsvLine& header, CsvReader& reader,
                                         const EarthPositions& earth) {
  constexpr std::array required{PlaceColumn::latitude, PlaceColumn::longitude, PlaceColumn::height};
  const PlaceTable table(header, required);
  std::vector<dvec3> positions;
  while (const std::optional<CsvLine> line = reader.next()) {
    table.check(*line);
    positions.push_back(table.position(*line, earth));
  }
  return positions;
}

}  // namespace

std::vector<dvec3> parse_receiver_list(std::string_view text, const std::string& name,
                                       const EarthPositions& earth) {
  std::vector<dvec3> positions;
  bool first = true;
  CsvReader reader(text, name);
  while (const std::optional<CsvLine> line = reader.next()) {
    const std::string_view cell = line->cells[0].text;
    const bool header = first && !cell.empty() && !csv_number(cell);
    first = false;
    if (header && PlaceTable::begins(*line))
      positions = parse_receiver_places(*line, reader, earth);  // to the end
    else if (header)
      check_receiver_header(*line);
    else
      positions.push_back(parse_position(*line));
  }
  if (positions.empty()) throw_user_error("{}: expected one position (x, y, z) or more, found none", name);
  return positions;
}

std::vector<dvec3> load_receiver_list(const std::filesystem::path& file, const EarthPositions& earth) {
  return parse_receiver_list(read_csv_file(file, "positions (x, y, z)"), file.string(), earth);
}

}  // namespace greatx::sim
