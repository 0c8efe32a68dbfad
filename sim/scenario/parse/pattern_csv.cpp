// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "sim/scenario/parse/pattern_csv.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <span>
#include <utility>

#include <fmt/ranges.h>

#include "core/hash.h"
#include "core/units.h"
#include "sim/scenario/parse/csv.h"

namespace greatx::sim {
namespace {

constexpr std::array<const char*, 3> gain_columns = {"theta_deg", "phi_deg", "gain_dbi"};
constexpr std::array<const char*, 6> field_columns = {"theta_deg",  "phi_deg",  "f_theta_re",
                                                      "f_theta_im", "f_phi_re", "f_phi_im"};
constexpr double angle_tolerance_deg = 1e-6;  ///< angles that differ by less are equal
constexpr double step_tolerance = 0.01;  ///< fraction of a step; angles are often written with few digits
/// Fraction of the largest amplitude, at the meridian that occurs twice.
constexpr double seam_tolerance = 1e-3;
constexpr double pole_tolerance = 0.1;     ///< fraction of the largest amplitude
constexpr double most_amplitude = 1e5;     ///< 100 dBi
constexpr size_t most_samples = 1u << 22;  ///< enough for steps of an eighth of a degree

struct Sample {
  double theta_deg = 0.0, phi_deg = 0.0;
  rf::Jones field;
  int line = 0;
};

class Parser {
 public:
  Parser(std::string_view text, const std::string& name) : text_(text), name_(name) {}
  rf::PatternTable parse();

 private:
  template <typename... Args>
  [[noreturn]] void fail(int line, fmt::format_string<Args...> format, Args&&... args) const {
    throw_user_error("{}:{}: {}", name_, line, fmt::format(format, std::forward<Args>(args)...));
  }
  void read_header(const CsvLine& line);
  double number(const CsvLine& line, size_t column) const;
  Sample sample(const CsvLine& line) const;
  /// Returns the samples' values of one angle, ascending, in even steps.
  std::vector<double> steps(double Sample::*angle, const char* column) const;
  void check_zeniths(const std::vector<double>& zeniths) const;
  /// Returns whether the last azimuth is the first one again.
  bool closed(const std::vector<double>& azimuths) const;
  int line_of(double Sample::*angle, double value) const;
  /// Returns the samples in the order of the grid, [zeniths, azimuths], the double meridian included.
  std::vector<const Sample*> gridded(const std::vector<double>& zeniths,
                                     const std::vector<double>& azimuths) const;
  void check_poles(std::span<const Sample* const> grid, size_t azimuths, double largest) const;

  std::string_view text_;
  const std::string& name_;
  std::span<const char* const> columns_;
  int header_line_ = 1;
  std::vector<Sample> samples_;
};

void Parser::read_header(const CsvLine& line) {
  std::vector<std::string> names;
  for (const CsvCell& cell : line.cells) names.push_back(lower_case(cell.text));
  for (const std::span<const char* const> columns :
       {std::span<const char* const>(gain_columns), std::span<const char* const>(field_columns)})
    if (std::equal(names.begin(), names.end(), columns.begin(), columns.end())) columns_ = columns;
  if (columns_.empty())
    line.fail(0, fmt::format("expected the header '{}' or '{}', found '{}'", fmt::join(gain_columns, ","),
                             fmt::join(field_columns, ","), fmt::join(names, ",")));
  header_line_ = line.number;
}

double Parser::number(const CsvLine& line, size_t column) const {
  const std::string_view text = line.cells[column].text;
  const std::optional<double> value = csv_number(text);
  const bool no_gain =
      columns_.size() == gain_columns.size() && column == 2 && value && *value < 0.0;  // -inf dBi
  if (!value || !(std::isfinite(*value) || no_gain))
    line.fail(column, fmt::format("{}: expected a finite number, found {}", columns_[column],
                                  text.empty() ? "a gap" : fmt::format("'{}'", text)));
  return *value;
}

Sample Parser::sample(const CsvLine& line) const {
  if (line.cells.size() != columns_.size())
    line.fail(line.cells.size() - 1, fmt::format("expected {} values ({}), found {}", columns_.size(),
                                                 fmt::join(columns_, ", "), line.cells.size()));
  std::array<double, field_columns.size()> values{};
  for (size_t i = 0; i < columns_.size(); ++i) values[i] = number(line, i);
  if (!(values[0] >= 0.0 && values[0] <= 180.0))
    line.fail(0, fmt::format("theta_deg: expected a zenith from 0 to 180 (0: up), found {}", values[0]));
  if (!(std::abs(values[1]) <= 360.0))
    line.fail(1, fmt::format("phi_deg: expected an azimuth from -360 to 360, found {}", values[1]));
  Sample sample{values[0], values[1], {}, line.number};
  if (columns_.size() == gain_columns.size())
    sample.field = {std::pow(10.0, values[2] / 20.0), 0.0};
  else
    sample.field = {rf::Complex(values[2], values[3]), rf::Complex(values[4], values[5])};
  if (!(std::hypot(std::abs(sample.field.theta), std::abs(sample.field.phi)) <= most_amplitude))
    line.fail(2, fmt::format("{}: expected a gain of at most 100 dBi, found '{}'", columns_[2],
                             line.cells[2].text));
  return sample;
}

int Parser::line_of(double Sample::*angle, double value) const {
  for (const Sample& sample : samples_)
    if (std::abs(sample.*angle - value) <= angle_tolerance_deg) return sample.line;
  return header_line_;
}

std::vector<double> Parser::steps(double Sample::*angle, const char* column) const {
  std::vector<double> values;
  for (const Sample& sample : samples_) values.push_back(sample.*angle);
  std::sort(values.begin(), values.end());
  values.erase(std::unique(values.begin(), values.end(),
                           [](double a, double b) { return b - a <= angle_tolerance_deg; }),
               values.end());
  std::vector<double> gaps;
  for (size_t i = 1; i < values.size(); ++i) gaps.push_back(values[i] - values[i - 1]);
  std::nth_element(gaps.begin(), gaps.begin() + static_cast<std::ptrdiff_t>(gaps.size() / 2), gaps.end());
  for (size_t i = 1; i < values.size(); ++i) {
    const double step = gaps[gaps.size() / 2];  // the median, so that the message names the odd step
    if (std::abs(values[i] - values[i - 1] - step) > step * step_tolerance)
      fail(line_of(angle, values[i]), "{}: expected even steps, {:.6g} after {:.6g}, found {:.6g}", column,
           values[i - 1] + step, values[i - 1], values[i]);
  }
  return values;
}

void Parser::check_zeniths(const std::vector<double>& zeniths) const {
  if (zeniths.front() > angle_tolerance_deg || zeniths.back() < 180.0 - angle_tolerance_deg)
    fail(
        line_of(&Sample::theta_deg, zeniths.front() > angle_tolerance_deg ? zeniths.front() : zeniths.back()),
        "theta_deg: expected zeniths from 0 to 180, found them from {} to {}", zeniths.front(),
        zeniths.back());
  if (zeniths.size() < 3)
    fail(header_line_, "theta_deg: expected 3 zeniths or more, found {}", zeniths.size());
}

bool Parser::closed(const std::vector<double>& azimuths) const {
  const double span = azimuths.back() - azimuths.front();
  const double step = azimuths.size() > 1 ? span / (static_cast<double>(azimuths.size()) - 1.0) : 360.0;
  const bool whole = std::abs(span - 360.0) <= step_tolerance * step;
  if (!whole && std::abs(span + step - 360.0) > step_tolerance * step)
    fail(line_of(&Sample::phi_deg, azimuths.back()),
         "phi_deg: expected azimuths once around (360 degrees), found {} from {} to {}", azimuths.size(),
         azimuths.front(), azimuths.back());
  if (azimuths.size() - whole < 4)
    fail(header_line_, "phi_deg: expected 4 azimuths or more, found {}", azimuths.size() - whole);
  return whole;
}

std::vector<const Sample*> Parser::gridded(const std::vector<double>& zeniths,
                                           const std::vector<double>& azimuths) const {
  const auto index = [](const std::vector<double>& values, double value) {
    const auto at = std::lower_bound(values.begin(), values.end(), value - 2.0 * angle_tolerance_deg);
    return static_cast<size_t>(at - values.begin());
  };
  // The samples are sorted by their place in the grid, not written into a grid. In a list in which every line
  // has its own angles, the grid would have as many places as the square of the lines.
  std::vector<std::pair<uint64_t, const Sample*>> places;
  places.reserve(samples_.size());
  for (const Sample& sample : samples_)
    places.emplace_back(
        uint64_t{index(zeniths, sample.theta_deg)} * azimuths.size() + index(azimuths, sample.phi_deg),
        &sample);
  std::sort(places.begin(), places.end());  // lines with one place stay in the order of the file
  const Sample *second = nullptr, *first = nullptr;
  for (size_t i = 1; i < places.size(); ++i)
    if (places[i].first == places[i - 1].first && (second == nullptr || places[i].second < second)) {
      second = places[i].second;
      first = places[i - 1].second;
    }
  if (second != nullptr)
    fail(second->line, "theta_deg {}, phi_deg {}: expected every direction once, found a second line like {}",
         second->theta_deg, second->phi_deg, first->line);
  const uint64_t expected = uint64_t{zeniths.size()} * azimuths.size();
  std::vector<const Sample*> grid;
  grid.reserve(places.size());
  for (uint64_t i = 0; i < expected; ++i) {
    if (i == places.size() || places[i].first != i)
      fail(i == 0 ? header_line_ : grid.back()->line,
           "theta_deg {:.6g}, phi_deg {:.6g}: expected a line, found none", zeniths[i / azimuths.size()],
           azimuths[i % azimuths.size()]);
    grid.push_back(places[i].second);
  }
  return grid;
}

void Parser::check_poles(std::span<const Sample* const> grid, size_t azimuths, double largest) const {
  const auto amplitude = [](const Sample* sample) {
    return std::hypot(std::abs(sample->field.theta), std::abs(sample->field.phi));
  };
  for (const auto& row : {grid.first(azimuths), grid.last(azimuths)})
    for (const Sample* sample : row)
      if (std::abs(amplitude(sample) - amplitude(row[0])) > pole_tolerance * largest)
        fail(sample->line,
             "theta_deg {}, phi_deg {}: expected the strength of phi_deg {} (line {}) at a pole, which is "
             "one direction, "
             "found an amplitude gain of {:.4g} beside {:.4g}",
             sample->theta_deg, sample->phi_deg, row[0]->phi_deg, row[0]->line, amplitude(sample),
             amplitude(row[0]));
}

rf::PatternTable Parser::parse() {
  CsvReader reader(text_, name_);
  while (const std::optional<CsvLine> line = reader.next()) {
    if (columns_.empty())
      read_header(*line);
    else
      samples_.push_back(sample(*line));
    if (samples_.size() > most_samples)
      line->fail(0, fmt::format("expected at most {} samples, found more", most_samples));
  }
  if (samples_.empty())
    throw_user_error("{}:{}: expected samples of a pattern, found none", name_, header_line_);
  const std::vector<double> zeniths = steps(&Sample::theta_deg, "theta_deg");
  check_zeniths(zeniths);
  const std::vector<double> azimuths = steps(&Sample::phi_deg, "phi_deg");
  const bool whole = closed(azimuths);
  const std::vector<const Sample*> grid = gridded(zeniths, azimuths);

  double largest = 0.0;
  for (const Sample& sample : samples_)
    largest = std::max({largest, std::abs(sample.field.theta), std::abs(sample.field.phi)});
  if (!(largest > 0.0)) fail(header_line_, "expected a gain somewhere, found none");
  check_poles(grid, azimuths.size(), largest);

  const size_t kept = azimuths.size() - whole;
  std::vector<rf::Jones> fields;
  for (size_t i = 0; i < zeniths.size(); ++i) {
    const Sample* const* const row = grid.data() + i * azimuths.size();
    for (size_t j = 0; j < kept; ++j) fields.push_back(row[j]->field);
    const rf::Jones &first = row[0]->field, &last = row[azimuths.size() - 1]->field;
    if (whole &&
        std::abs(first.theta - last.theta) + std::abs(first.phi - last.phi) > seam_tolerance * largest)
      fail(row[kept]->line,
           "theta_deg {}, phi_deg {}: expected the values of phi_deg {} (line {}), found others",
           row[kept]->theta_deg, row[kept]->phi_deg, row[0]->phi_deg, row[0]->line);
  }
  return rf::PatternTable(
      {static_cast<uint32_t>(zeniths.size()), static_cast<uint32_t>(kept), radians(azimuths[0])},
      std::move(fields), std::filesystem::path(name_).filename().string(), Sha256().update(text_).hex());
}

}  // namespace

rf::PatternTable parse_pattern_csv(std::string_view text, const std::string& name) {
  return Parser(text, name).parse();
}

rf::PatternTable load_pattern_csv(const std::filesystem::path& file) {
  return parse_pattern_csv(read_csv_file(file, "an antenna pattern (theta_deg, phi_deg, ...)"),
                           file.string());
}

}  // namespace greatx::sim
