// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "sim/scenario/parse/trajectory_csv.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "core/expected.h"
#include "core/units.h"
#include "sim/scenario/limits.h"
#include "sim/scenario/parse/csv.h"
#include "sim/scenario/parse/place_table.h"

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

/// Returns a point of the given time; it has an attitude if `angles_deg` are given.
WayPoint way_point(double time_s, const dvec3& position, const std::optional<dvec3>& angles_deg) {
  WayPoint point{time_s, position, std::nullopt};
  if (angles_deg)
    point.orientation = orientation_from_yaw_pitch_roll(radians(angles_deg->x), radians(angles_deg->y),
                                                        radians(angles_deg->z));
  return point;
}

WayPoint parse_point(const CsvLine& line, LogTimes& times) {
  check_count(line);
  const auto number = [&](size_t i, double most) {
    const auto value = csv_number(line.cells[i].text);
    if (!value || !std::isfinite(*value))
      fail(line, i, "a finite number", fmt::format("'{}'", line.cells[i].text));
    if (std::abs(*value) > most)
      fail(line, i, number_range(-most, most), fmt::format("'{}'", line.cells[i].text));
    return *value;
  };
  const auto vector = [&](size_t i, double most) {
    return dvec3(number(i, most), number(i + 1, most), number(i + 2, most));
  };
  const double time_s = times.next(
      line.cells[0].text,
      [&](const std::string& expected, const std::string& found) { fail(line, 0, expected, found); });
  std::optional<dvec3> angles_deg;
  const dvec3 position = vector(1, most_position_m);
  if (line.cells.size() == 7) angles_deg = vector(4, most_angle_deg);
  return way_point(time_s, position, angles_deg);
}

/// Parses the lines behind a header that names places on the Earth.
std::vector<WayPoint> parse_places(const CsvLine& header, CsvReader& reader, const WayPointLog& log) {
  using enum PlaceColumn;
  constexpr std::array required{time, latitude, longitude, height};
  constexpr std::array optional{yaw, pitch, roll};
  const PlaceTable table(header, required, optional);
  LogTimes times(log);
  std::vector<WayPoint> points;
  while (const std::optional<CsvLine> line = reader.next()) {
    table.check(*line);
    const double time_s = times.next(line->cells[table.cell(time)].text,
                                     [&](const std::string& expected, const std::string& found) {
                                       table.fail(*line, time, expected, found);
                                     });
    std::optional<dvec3> angles_deg;
    if (table.has(yaw))
      angles_deg = {table.number(*line, yaw, most_angle_deg), table.number(*line, pitch, most_angle_deg),
                    table.number(*line, roll, most_angle_deg)};
    points.push_back(way_point(time_s, table.position(*line, log.earth), angles_deg));
  }
  return points;
}

/// Parses lines in metres. `first` is the first of them, or a header.
std::vector<WayPoint> parse_metres(const CsvLine& first, CsvReader& reader, const WayPointLog& log) {
  std::vector<WayPoint> points;
  LogTimes times(log);
  const size_t columns = first.cells.size();
  if (csv_number(first.cells[0].text))
    points.push_back(parse_point(first, times));
  else
    check_trajectory_header(first);
  while (const std::optional<CsvLine> line = reader.next()) {
    check_count(*line);
    if (line->cells.size() != columns)
      line->fail(line->cells.size() - 1, fmt::format("expected {} values as in the lines before, found {}",
                                                     columns, line->cells.size()));
    points.push_back(parse_point(*line, times));
  }
  return points;
}

}  // namespace

std::vector<WayPoint> parse_way_points(std::string_view text, const std::string& name,
                                       const WayPointLog& log) {
  CsvReader reader(text, name);
  std::vector<WayPoint> points;
  if (const std::optional<CsvLine> first = reader.next())
    points =
        PlaceTable::begins(*first) ? parse_places(*first, reader, log) : parse_metres(*first, reader, log);
  if (points.empty()) throw_user_error("{}: expected one way-point or more, found none", name);
  return points;
}

std::vector<WayPoint> load_way_points(const std::filesystem::path& file, const WayPointLog& log) {
  return parse_way_points(read_csv_file(file, "way-points"), file.string(), log);
}

}  // namespace greatx::sim
