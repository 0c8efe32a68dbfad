// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "sim/scenario/parse/shot_csv.h"

#include <array>
#include <cmath>

#include "core/hash.h"
#include "core/units.h"
#include "sim/scenario/parse/csv.h"

namespace greatx::sim {
namespace {

constexpr std::array<const char*, 4> shot_columns = {"t_s", "azimuth_deg", "elevation_deg", "channel"};

[[noreturn]] void fail(const CsvLine& line, size_t cell, const std::string& expected) {
  line.fail(cell,
            fmt::format("{}: expected {}, found '{}'", shot_columns[cell], expected, line.cells[cell].text));
}

void check_count(const CsvLine& line, size_t columns) {
  const size_t count = line.cells.size();
  if (columns == 0 ? count == 3 || count == 4 : count == columns) return;
  line.fail(count - 1,
            columns == 0
                ? fmt::format("expected 3 or 4 values (t_s, azimuth_deg, elevation_deg[, channel]), found {}",
                              count)
                : fmt::format("expected {} values as in the lines before, found {}", columns, count));
}

void check_shot_header(const CsvLine& line) {
  check_count(line, 0);
  for (size_t i = 0; i < line.cells.size(); ++i)
    if (lower_case(line.cells[i].text) != shot_columns[i])
      fail(line, i, fmt::format("a number, or '{}' in a header line", shot_columns[i]));
}

double number(const CsvLine& line, size_t cell, double low, double high, const std::string& expected) {
  const auto value = csv_number(line.cells[cell].text);
  if (!value || !(*value >= low && *value <= high)) fail(line, cell, expected);
  return *value;
}

render::TableShot parse_shot(const CsvLine& line) {
  render::TableShot shot;
  shot.time_s = number(line, 0, 0.0, 1e6, "a time after the tick of 0 or more");
  shot.azimuth = radians(number(line, 1, -360.0, 360.0, "an azimuth from -360 to 360"));
  shot.elevation = radians(number(line, 2, -90.0, 90.0, "an elevation from -90 to 90"));
  if (line.cells.size() == 4) {
    const std::string expected = "a whole number from 0 to 65534";
    const double channel = number(line, 3, 0.0, 65534.0, expected);
    if (channel != std::floor(channel)) fail(line, 3, expected);
    shot.channel = static_cast<uint16_t>(channel);
  }
  return shot;
}

}  // namespace

render::ShotTable parse_shots(std::string_view text, const std::string& name) {
  render::ShotTable table{{}, std::filesystem::path(name).filename().string(), Sha256().update(text).hex()};
  size_t columns = 0;  // number of columns in the first line
  CsvReader reader(text, name);
  while (const std::optional<CsvLine> line = reader.next()) {
    if (columns == 0 && !csv_number(line->cells[0].text)) {
      check_shot_header(*line);
      columns = line->cells.size();
      continue;
    }
    check_count(*line, columns);
    columns = line->cells.size();
    const render::TableShot shot = parse_shot(*line);
    if (!table.shots.empty() && shot.time_s < table.shots.back().time_s)
      fail(*line, 0, fmt::format("a time not before the one before, {}", table.shots.back().time_s));
    if (table.shots.size() == render::most_columns)
      line->fail(0, fmt::format("expected at most {} shots, found more", render::most_columns));
    table.shots.push_back(shot);
  }
  if (table.shots.empty()) throw_user_error("{}: expected one shot or more, found none", name);
  return table;
}

render::ShotTable load_shots(const std::filesystem::path& file) {
  return parse_shots(read_csv_file(file, "shots (t_s, azimuth_deg, elevation_deg[, channel])"),
                     file.string());
}

}  // namespace greatx::sim
