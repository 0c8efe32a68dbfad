// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "sim/scenario/parse/trajectory_csv.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "core/units.h"
#include "sim/scenario/limits.h"
#include "sim/scenario/parse/csv.h"

namespace greatx::sim {
namespace {

constexpr std::array<const char*, 7> trajectory_columns = {"t",       "x",         "y",       "z",
                                                           "yaw_deg", "pitch_deg", "roll_deg"};

[[noreturn]] void fail(const CsvLine& line, size_t cell, const std::string& expected,
                       const std::string& found) {
  line.fail(cell,
            fmt::format("{}expected {}, found {}",
                        cell < trajectory_columns.size() ? std::string(trajectory_columns[cell]) + ": " : "",
                        expected, found));
}

void check_count(const CsvLine& line) {
  const size_t count = line.cells.size();
  if (count != 4 && count != 7)
    line.fail(
        count - 1,
        fmt::format("expected 4 or 7 values (t, x, y, z[, yaw_deg, pitch_deg, roll_deg]), found {}", count));
}

/// Checks the names of a header, since one in another order would be read as garbage.
void check_trajectory_header(const CsvLine& line) {
  check_count(line);
  constexpr std::array<std::array<const char*, 4>, 7> spellings = {{{"t", "t_s", "time", "time_s"},
                                                                    {"x", "x_m"},
                                                                    {"y", "y_m"},
                                                                    {"z", "z_m"},
                                                                    {"yaw_deg"},
                                                                    {"pitch_deg"},
                                                                    {"roll_deg"}}};
  for (size_t i = 0; i < line.cells.size(); ++i) {
    const std::string name = lower_case(line.cells[i].text);
    const bool known = std::any_of(spellings[i].begin(), spellings[i].end(),
                                   [&](const char* spelling) { return spelling && name == spelling; });
    if (!known)
      fail(line, i, fmt::format("a number, or '{}' in a header line", trajectory_columns[i]),
           fmt::format("'{}'", line.cells[i].text));
  }
}

WayPoint parse_point(const CsvLine& line) {
  check_count(line);
  std::array<double, 7> values{};
  for (size_t i = 0; i < line.cells.size(); ++i) {
    const auto value = csv_number(line.cells[i].text);
    if (!value || !std::isfinite(*value))
      fail(line, i, "a finite number", fmt::format("'{}'", line.cells[i].text));
    const double most = i == 0 ? most_time_s : i < 4 ? most_position_m : most_angle_deg;
    if (std::abs(*value) > most)
      fail(line, i, fmt::format("a number from {:g} to {:g}", -most, most),
           fmt::format("'{}'", line.cells[i].text));
    values[i] = *value;
  }
  WayPoint point{values[0], {values[1], values[2], values[3]}, std::nullopt};
  if (line.cells.size() == 7)
    point.orientation =
        orientation_from_yaw_pitch_roll(radians(values[4]), radians(values[5]), radians(values[6]));
  return point;
}

}  // namespace

std::vector<WayPoint> parse_way_points(std::string_view text, const std::string& name) {
  std::vector<WayPoint> points;
  size_t columns = 0;  // number of columns in the first line
  CsvReader reader(text, name);
  while (const std::optional<CsvLine> line = reader.next()) {
    if (columns == 0 && !csv_number(line->cells[0].text)) {
      check_trajectory_header(*line);
      columns = line->cells.size();
      continue;
    }
    const WayPoint point = parse_point(*line);
    if (columns != 0 && line->cells.size() != columns)
      line->fail(line->cells.size() - 1, fmt::format("expected {} values as in the lines before, found {}",
                                                     columns, line->cells.size()));
    columns = line->cells.size();
    if (!points.empty() && !(point.time_s > points.back().time_s))
      fail(*line, 0, fmt::format("a time greater than the one before, {}", points.back().time_s),
           fmt::format("'{}'", line->cells[0].text));
    points.push_back(point);
  }
  if (points.empty()) throw_user_error("{}: expected one way-point or more, found none", name);
  return points;
}

std::vector<WayPoint> load_way_points(const std::filesystem::path& file) {
  return parse_way_points(read_csv_file(file, "way-points"), file.string());
}

}  // namespace greatx::sim
