// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "apps/fit/measurement_file.h"

#include <array>
#include <cmath>
#include <complex>
#include <optional>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "core/expected.h"
#include "core/hash.h"
#include "core/text.h"
#include "core/units.h"
#include "io/files/file.h"
#include "io/formats/npy.h"
#include "sim/fit/signal.h"
#include "sim/scenario/limits.h"
#include "sim/scenario/parse/csv.h"

namespace greatx::apps {
namespace {

using Complex = std::complex<double>;
namespace fs = std::filesystem;

constexpr size_t most_positions = 1'000'000;

/// The columns of a table: x, y, z, the value, and the angles.
enum Column : size_t {
  column_x,
  column_y,
  column_z,
  column_value,
  column_yaw,
  column_pitch,
  column_roll,
  columns
};
constexpr std::array<const char*, columns> column_keys{"x", "y", "z", "value", "yaw", "pitch", "roll"};

/// Returns the names that the file may use for each column.
std::array<std::vector<std::string>, columns> column_names(const FieldMap& map, const sim::FitSet& set) {
  std::array<std::vector<std::string>, columns> names{{{"x", "x_m"},
                                                       {"y", "y_m"},
                                                       {"z", "z_m"},
                                                       {sim::name_of(set.quantity), "value"},
                                                       {"yaw_deg"},
                                                       {"pitch_deg"},
                                                       {"roll_deg"}}};
  if (const auto f = map.find("columns")) {
    const FieldMap given(*f, Keys(column_keys.begin(), column_keys.end()));
    for (size_t c = 0; c < columns; ++c)
      if (const auto name = given.find(column_keys[c])) names[c] = {sim::lower_case(name->text())};
  }
  return names;
}

class Table {
 public:
  /// Takes the header.
  Table(const sim::CsvLine& header, const std::array<std::vector<std::string>, columns>& names)
      : width_(header.cells.size()) {
    std::vector<std::string> found;
    for (const sim::CsvCell& cell : header.cells) found.push_back(sim::lower_case(cell.text));
    for (size_t c = 0; c < columns; ++c)
      for (size_t i = 0; i < found.size(); ++i)
        if (std::ranges::find(names[c], found[i]) != names[c].end()) {
          if (cells_[c])
            header.fail(i, fmt::format("{}: expected one column, found a second", column_keys[c]));
          cells_[c] = i;
        }
    for (const size_t c : {column_x, column_y, column_z, column_value})
      if (!cells_[c])
        header.fail(0, fmt::format("{}: expected a column '{}' in the header, found {}", column_keys[c],
                                   fmt::join(names[c], "' or '"), fmt::join(found, ", ")));
    const bool angles[] = {has(column_yaw), has(column_pitch), has(column_roll)};
    if ((angles[1] || angles[2]) && !angles[0])
      header.fail(0, fmt::format("yaw: expected a column '{}' beside the other angles, found none",
                                 fmt::join(names[column_yaw], "' or '")));
  }
  bool has(size_t column) const { return cells_[column].has_value(); }
  void check(const sim::CsvLine& line) const {
    if (line.cells.size() != width_)
      line.fail(line.cells.size() - 1,
                fmt::format("expected {} values as in the header, found {}", width_, line.cells.size()));
  }
  /// Returns a finite number from -most to most.
  double number(const sim::CsvLine& line, size_t column, double most) const {
    const std::optional<double> value = sim::csv_number(line.cells[*cells_[column]].text);
    if (!value || !(std::abs(*value) <= most)) fail(line, column, number_range(-most, most));
    return *value;
  }
  /// Returns a measured value; NaN for a gap.
  double value(const sim::CsvLine& line) const {
    const std::string_view text = line.cells[*cells_[column_value]].text;
    if (text.empty()) return NAN;
    const std::optional<double> value = sim::csv_number(text);
    if (!value || std::isinf(*value)) fail(line, column_value, "a finite number, nan or nothing");
    return *value;
  }

 private:
  [[noreturn]] void fail(const sim::CsvLine& line, size_t column, const std::string& expected) const {
    const std::string_view text = line.cells[*cells_[column]].text;
    line.fail(*cells_[column], fmt::format("{}: expected {}, found {}", column_keys[column], expected,
                                           text.empty() ? "a gap" : fmt::format("'{}'", text)));
  }
  size_t width_;
  std::array<std::optional<size_t>, columns> cells_;
};

void check_count(const std::string& name, size_t count) {
  if (count == 0) throw_user_error("{}: expected one measured position or more, found none", name);
  if (count > most_positions)
    throw_user_error("{}: expected at most {} positions, found {}", name, most_positions, count);
}

void check_value(const sim::FitSet& set, double value, const std::function<void(const char*)>& fail) {
  if (set.quantity == sim::FitQuantity::delay_spread_ns && value < 0.0)
    fail("a delay spread of 0 ns or more");
  if (set.quantity != sim::FitQuantity::delay_spread_ns && std::abs(value) > 1000.0)
    fail("a level from -1000 to 1000 dB");
}

void read_table(const fs::path& file, const FieldMap& map, sim::FitSet& set) {
  const std::string text = sim::read_csv_file(file, "measurements"), name = file.string();
  sim::CsvReader reader(text, name);
  const std::optional<sim::CsvLine> header = reader.next();
  if (!header) throw_user_error("{}: expected a header line and measurements, found nothing", name);
  const Table table(*header, column_names(map, set));
  while (const std::optional<sim::CsvLine> line = reader.next()) {
    table.check(*line);
    const auto number = [&](size_t column, double most) { return table.number(*line, column, most); };
    set.points.emplace_back(number(column_x, sim::most_position_m), number(column_y, sim::most_position_m),
                            number(column_z, sim::most_position_m));
    if (table.has(column_yaw))
      set.orientations.push_back(
          orientation_from_yaw_pitch_roll(radians(number(column_yaw, 1e6)),
                                          table.has(column_pitch) ? radians(number(column_pitch, 1e6)) : 0.0,
                                          table.has(column_roll) ? radians(number(column_roll, 1e6)) : 0.0));
    set.values.push_back(table.value(*line));
    check_value(set, set.values.back(), [&](const char* expected) {
      line->fail(0, fmt::format("value: expected {}, found {}", expected, set.values.back()));
    });
  }
  check_count(name, set.points.size());
}

std::string shape_words(const std::vector<int64_t>& shape) {
  return fmt::format("[{}]", fmt::join(shape, ", "));
}

/// Returns the values of an array of real numbers.
std::vector<double> real_values(const Array& array) {
  if (array.dtype == DType::f64) return {array.as<double>().begin(), array.as<double>().end()};
  return {array.as<float>().begin(), array.as<float>().end()};
}

void read_points(const fs::path& file, sim::FitSet& set) {
  const io::NpyFile npy(file);
  if (npy.shape().size() != 2 || npy.shape()[1] != 3 ||
      (npy.dtype() != DType::f64 && npy.dtype() != DType::f32))
    throw_user_error("{}: expected positions, float64 or float32 [positions, 3], found {} {}", file.string(),
                     numpy_name(npy.dtype()), shape_words(npy.shape()));
  check_count(file.string(), static_cast<size_t>(npy.rows()));
  const std::vector<double> values = real_values(npy.read());
  for (size_t i = 0; i < values.size(); i += 3) {
    for (size_t c = 0; c < 3; ++c)
      if (!(std::abs(values[i + c]) <= sim::most_position_m))
        throw_user_error("{}: position {}: expected {}, found {}", file.string(), i / 3,
                         number_range(-sim::most_position_m, sim::most_position_m), values[i + c]);
    set.points.emplace_back(values[i], values[i + 1], values[i + 2]);
  }
}

void read_values(const fs::path& file, sim::FitSet& set) {
  const io::NpyFile npy(file);
  const auto count = static_cast<int64_t>(set.points.size());
  const bool response = set.quantity == sim::FitQuantity::cir || set.quantity == sim::FitQuantity::cfr;
  std::vector<int64_t> shape{count};
  if (response) shape.push_back(set.width);
  const bool is_complex = npy.dtype() == DType::complex64,
             is_real = npy.dtype() == DType::f64 || npy.dtype() == DType::f32;
  const bool good_type = set.complex_values ? is_complex : is_real || (response && is_complex);
  if (npy.shape() != shape || !good_type)
    throw_user_error("{}: expected {} {}, found {} {}", file.string(),
                     set.complex_values ? "complex64"
                     : response         ? "float64 or float32 (dB) or complex64"
                                        : "float64 or float32",
                     shape_words(shape), numpy_name(npy.dtype()), shape_words(npy.shape()));
  const Array array = npy.read();
  if (is_complex)
    for (const std::complex<float>& value : array.as<std::complex<float>>()) {
      set.responses.emplace_back(value);
      if (!set.complex_values) set.values.push_back(decibels(std::norm(set.responses.back())));
    }
  else
    set.values = real_values(array);
  if (!set.complex_values) set.responses.clear();
  for (size_t i = 0; i < set.values.size(); ++i) {
    if (set.values[i] == -INFINITY) set.values[i] = -1000.0;  // a tap without power, far below any floor
    check_value(set, set.values[i], [&](const char* expected) {
      throw_user_error("{}: value {}: expected {}, found {}", file.string(), i, expected, set.values[i]);
    });
  }
  if (!set.complex_values || set.quantity != sim::FitQuantity::cir) return;
  for (size_t position = 0; position < set.points.size(); ++position) {
    const std::span taps = std::span(set.responses).subspan(position * set.width, set.width);
    const std::vector<Complex> response_there = sim::response_of_taps(taps);
    std::ranges::copy(response_there, taps.begin());
  }
}

}  // namespace

void read_measurements(const FieldMap& map, sim::FitSet& set, std::vector<FitData>& data) {
  const auto note = [&](const fs::path& file) {
    data.push_back({file.filename().string(), io::sha256_of(io::File::open_for_reading(file))});
  };
  const bool response = set.quantity == sim::FitQuantity::cir || set.quantity == sim::FitQuantity::cfr;
  if (const auto f = map.find("file")) {
    map.exclude("file", "positions");
    map.exclude("file", "values");
    if (response)
      f->refuse(fmt::format("expected positions and values (.npy) for a {}, found a table",
                            sim::name_of(set.quantity)));
    const fs::path file = f->file();
    note(file);
    return read_table(file, map, set);
  }
  const Field positions = map.require("positions", "file (CSV), or positions and values (.npy)"),
              values = map.require("values", "values (.npy) beside the positions");
  if (const auto f = map.find("columns")) f->refuse("expected a file (CSV) beside it");
  const fs::path points_file = positions.file(), values_file = values.file();
  note(points_file);
  note(values_file);
  read_points(points_file, set);
  read_values(values_file, set);
}

}  // namespace greatx::apps
