// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "sim/trajectory_csv.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <fstream>
#include <sstream>

#include "core/units.h"

namespace greatx::sim {
namespace {

constexpr std::array<const char*, 7> column_names = {"t", "x", "y", "z", "yaw_deg", "pitch_deg", "roll_deg"};

/// A cell of a line without the blanks around it.
struct Cell {
  std::string_view text;
  size_t column = 1;  ///< 1-based, in bytes
};

struct Line {
  const std::string& file;
  int number = 0;
  std::vector<Cell> cells;

  [[noreturn]] void fail(size_t cell, const std::string& expected, const std::string& found) const {
    throw_user_error("{}:{}:{}: {}expected {}, found {}", file, number, cells[cell].column,
                     cell < column_names.size() ? std::string(column_names[cell]) + ": " : "", expected,
                     found);
  }
};

std::vector<Cell> split(std::string_view line) {
  std::vector<Cell> cells;
  for (size_t begin = 0; begin <= line.size();) {
    const size_t end = std::min(line.find(',', begin), line.size());
    size_t first = begin, last = end;
    while (first < last && (line[first] == ' ' || line[first] == '\t')) ++first;
    while (last > first && (line[last - 1] == ' ' || line[last - 1] == '\t')) --last;
    cells.push_back({line.substr(first, last - first), first + 1});
    begin = end + 1;
  }
  return cells;
}

std::optional<double> number_of(std::string_view text) {
  if (text.starts_with('+')) text.remove_prefix(1);
  double value = 0.0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc{} || end != text.data() + text.size() || text.empty()) return std::nullopt;
  return value;
}

void check_count(const Line& line) {
  const size_t count = line.cells.size();
  if (count != 4 && count != 7)
    throw_user_error(
        "{}:{}:{}: expected 4 or 7 values (t, x, y, z[, yaw_deg, pitch_deg, roll_deg]), found {}", line.file,
        line.number, line.cells.back().column, count);
}

/// A header in another order would be read as garbage: its names are checked.
void check_header(const Line& line) {
  check_count(line);
  constexpr std::array<std::array<const char*, 4>, 7> spellings = {{{"t", "t_s", "time", "time_s"},
                                                                    {"x", "x_m"},
                                                                    {"y", "y_m"},
                                                                    {"z", "z_m"},
                                                                    {"yaw_deg"},
                                                                    {"pitch_deg"},
                                                                    {"roll_deg"}}};
  for (size_t i = 0; i < line.cells.size(); ++i) {
    std::string name(line.cells[i].text);
    for (char& c : name) c = c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c;
    const bool known = std::any_of(spellings[i].begin(), spellings[i].end(),
                                   [&](const char* spelling) { return spelling && name == spelling; });
    if (!known)
      line.fail(i, fmt::format("a number, or '{}' in a header line", column_names[i]),
                fmt::format("'{}'", line.cells[i].text));
  }
}

WayPoint parse_point(const Line& line) {
  check_count(line);
  std::array<double, 7> values{};
  for (size_t i = 0; i < line.cells.size(); ++i) {
    const auto value = number_of(line.cells[i].text);
    if (!value || !std::isfinite(*value))
      line.fail(i, "a finite number", fmt::format("'{}'", line.cells[i].text));
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
  if (text.starts_with("\xEF\xBB\xBF")) text.remove_prefix(3);
  std::vector<WayPoint> points;
  size_t columns = 0;  // of the first line that is no comment
  int number = 0;
  for (size_t begin = 0; begin < text.size();) {
    const size_t end = std::min(text.find('\n', begin), text.size());
    std::string_view content = text.substr(begin, end - begin);
    begin = end + 1;
    ++number;
    if (content.ends_with('\r')) content.remove_suffix(1);
    const size_t first = content.find_first_not_of(" \t");
    if (first == std::string_view::npos || content[first] == '#') continue;
    const Line line{name, number, split(content)};
    if (columns == 0 && !number_of(line.cells[0].text)) {
      check_header(line);
      columns = line.cells.size();
      continue;
    }
    const WayPoint point = parse_point(line);
    if (columns != 0 && line.cells.size() != columns)
      throw_user_error("{}:{}:{}: expected {} values as in the lines before, found {}", name, number,
                       line.cells.back().column, columns, line.cells.size());
    columns = line.cells.size();
    if (!points.empty() && !(point.time_s > points.back().time_s))
      line.fail(0, fmt::format("a time greater than the one before, {}", points.back().time_s),
                fmt::format("'{}'", line.cells[0].text));
    points.push_back(point);
  }
  if (points.empty()) throw_user_error("{}: expected one way-point or more, found none", name);
  return points;
}

std::vector<WayPoint> load_way_points(const std::filesystem::path& file) {
  std::ifstream stream(file, std::ios::binary);
  std::ostringstream text;
  text << stream.rdbuf();
  if (!stream)
    throw_user_error("{}: expected a readable file of way-points, found one that cannot be read",
                     file.string());
  return parse_way_points(text.str(), file.string());
}

}  // namespace greatx::sim
